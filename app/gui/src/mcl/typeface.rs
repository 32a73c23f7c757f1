//! The window's fixed font in a PDF: the letters that a text uses, embedded so that they look alike everywhere and can be copied.

use crate::mcl::messages::PrintMessage;
use egui::FontDefinitions;
use egui::epaint::text::FontData;
use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Name, Pdf, Rect, Ref, Str};
use skrifa::charmap::Charmap;
use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, MetadataProvider};
use std::collections::BTreeMap;
use std::sync::Arc;
use subsetter::{GlyphRemapper, subset};

/// The font's name in the window.
const NAME: &str = "Hack";
/// The same with a tag of six letters before it, which tells that not all letters are there (PDF 32000-1, 9.6.4).
const SUBSET: Name<'static> = Name(b"BRUSHW+Hack");
/// Glyphs have numbers of their own, in two bytes each (PDF 32000-1, 9.7.5.2).
const IDENTITY: SystemInfo<'static> =
    SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };

/// The file of the window's fixed font.
pub struct FontFace(Arc<FontData>);

impl FontFace {
    /// None where the window has no such font.
    pub fn of_the_window() -> Option<Self> {
        FontDefinitions::default().font_data.remove(NAME).map(Self)
    }

    /// The font, with no letter used yet.
    pub fn typeface(&self) -> Result<Typeface<'_>, String> {
        let font = FontRef::from_index((*self.0.font).as_ref(), self.0.index)
            .map_err(|error| PrintMessage::FontUnread { error: error.to_string() }.to_string())?;
        let (charmap, used) = (font.charmap(), GlyphRemapper::new());
        Ok(Typeface { data: &self.0, font, charmap, used, letters: BTreeMap::new() })
    }
}

/// A font and the letters that were used of it.
pub struct Typeface<'a> {
    data: &'a FontData,
    font: FontRef<'a>,
    charmap: Charmap<'a>,
    used: GlyphRemapper,
    /// What each glyph of the subset stands for.
    letters: BTreeMap<u16, char>,
}

impl Typeface<'_> {
    /// A text as the numbers of its glyphs. A letter that the font lacks is its box.
    pub fn glyphs(&mut self, text: &str) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(2 * text.len());
        for letter in text.chars() {
            let glyph = self.charmap.map(letter).map_or(0, skrifa::GlyphId::to_u32);
            let number = self.used.remap(u16::try_from(glyph).unwrap_or_default());
            self.letters.entry(number).or_insert(letter);
            bytes.extend(number.to_be_bytes());
        }
        bytes
    }

    /// Writes the letters used as the font of this number.
    pub fn embed(self, pdf: &mut Pdf, font: Ref, numbers: &mut Ref) -> Result<(), String> {
        let [descendant, descriptor, file, names] = [(); 4].map(|()| numbers.bump());
        let bytes = subset((*self.data.font).as_ref(), self.data.index, &self.used)
            .map_err(|error| PrintMessage::FontNotEmbedded { error: error.to_string() }.to_string())?;
        pdf.stream(file, &bytes);
        let mut letters = UnicodeCmap::new(Name(b"Letters"), IDENTITY);
        self.letters.iter().for_each(|(glyph, letter)| letters.pair(*glyph, *letter));
        pdf.cmap(names, &letters.finish());

        pdf.type0_font(font)
            .base_font(SUBSET)
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(descendant)
            .to_unicode(names);
        // Glyph space has 1000 units to the size (PDF 32000-1, 9.2.4).
        let metrics = self.font.metrics(Size::new(1000.0), LocationRef::default());
        pdf.cid_font(descendant)
            .subtype(CidFontType::Type2)
            .base_font(SUBSET)
            .system_info(IDENTITY)
            .font_descriptor(descriptor)
            .default_width(metrics.average_width.unwrap_or(600.0))
            .cid_to_gid_map_predefined(Name(b"Identity"));
        let bounds = metrics.bounds.unwrap_or_default();
        pdf.font_descriptor(descriptor)
            .name(SUBSET)
            .flags(FontFlags::FIXED_PITCH | FontFlags::SYMBOLIC)
            .italic_angle(0.0)
            .bbox(Rect::new(bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max))
            .ascent(metrics.ascent)
            .descent(metrics.descent)
            .cap_height(metrics.cap_height.unwrap_or(metrics.ascent))
            .stem_v(80.0)
            .font_file2(file);
        Ok(())
    }
}
