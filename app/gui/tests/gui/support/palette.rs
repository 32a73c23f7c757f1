//! A palette for kept pictures, which makes them small: the most frequent colours stand for themselves, each other one by the nearest of those.

use std::cmp::Reverse;
use std::collections::HashMap;

use image::RgbaImage;

type Colour = [u8; 3];

pub struct Palette {
    colours: Vec<Colour>,
    stands_for: HashMap<Colour, u8>,
}

impl Palette {
    /// So many colours for all of these pictures.
    pub fn of<'a>(pictures: impl IntoIterator<Item = &'a RgbaImage>, most: usize) -> Self {
        let mut counts: HashMap<Colour, usize> = HashMap::new();
        for picture in pictures {
            picture.pixels().for_each(|pixel| *counts.entry(colour(pixel)).or_default() += 1);
        }
        let mut by_count: Vec<(Colour, usize)> = counts.into_iter().collect();
        by_count.sort_by_key(|(colour, count)| (Reverse(*count), *colour));
        let colours: Vec<Colour> = by_count.iter().take(most).map(|(colour, _)| *colour).collect();
        let nearest = |colour: Colour| {
            let of = (0..colours.len()).min_by_key(|index| away(colours[*index], colour));
            of.unwrap_or_default() as u8
        };
        let stands_for = by_count.iter().map(|(colour, _)| (*colour, nearest(*colour))).collect();
        Self { colours, stands_for }
    }

    /// Red, green and blue of each colour, as a PNG has them.
    pub fn bytes(&self) -> Vec<u8> {
        self.colours.concat()
    }

    /// A picture by the numbers of its colours.
    pub fn indices(&self, picture: &RgbaImage) -> Vec<u8> {
        picture.pixels().map(|pixel| self.stands_for[&colour(pixel)]).collect()
    }
}

fn colour(pixel: &image::Rgba<u8>) -> Colour {
    [pixel[0], pixel[1], pixel[2]]
}

fn away(one: Colour, other: Colour) -> u32 {
    one.iter().zip(other).map(|(a, b)| u32::from(a.abs_diff(b)).pow(2)).sum()
}
