//! A picture as SVG text. Every number is written with two digits: a hundredth of a pixel is enough for print.

use std::fmt::Write as _;

use egui::{Align, Color32, Pos2, Rect};

use super::{Element, Picture};

/// The whole file: `size` is the picture's place, `background` lies behind it.
pub fn svg(picture: &Picture, size: Rect, background: Color32, title: &str) -> String {
    let mut out = String::new();
    let (x, y, width, height) = (size.left(), size.top(), size.width(), size.height());
    let _ = write!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
         viewBox=\"{x:.2} {y:.2} {width:.2} {height:.2}\">\n<title>{}</title>\n",
        escaped(title)
    );
    element(&mut out, &Element::Box { rect: size, color: background });
    for (number, layer) in picture.iter().enumerate() {
        let Rect { min, max } = layer.clip;
        let _ = write!(
            out,
            "<clipPath id=\"clip{number}\"><rect x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\"/></clipPath>\n\
             <g clip-path=\"url(#clip{number})\">\n",
            min.x,
            min.y,
            max.x - min.x,
            max.y - min.y
        );
        layer.elements.iter().for_each(|each| element(&mut out, each));
        out.push_str("</g>\n");
    }
    out.push_str("</svg>\n");
    out
}

// Writing into a String cannot fail.
fn element(out: &mut String, element: &Element) {
    let _ = match element {
        Element::Box { rect, color } => writeln!(
            out,
            "<rect x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\" fill={}/>",
            rect.left(),
            rect.top(),
            rect.width(),
            rect.height(),
            paint("fill", *color)
        ),
        Element::Line { points, color, width } => writeln!(
            out,
            "<polyline points=\"{}\" fill=\"none\" stroke-width=\"{width:.2}\" stroke-linejoin=\"round\" stroke={}/>",
            places(points),
            paint("stroke", *color)
        ),
        Element::Bars { bars, color, width } => writeln!(
            out,
            "<polyline points=\"{}\" fill=\"none\" stroke-width=\"{width:.2}\" stroke-linejoin=\"round\" stroke={}/>",
            places(bars.as_flattened()),
            paint("stroke", *color)
        ),
        Element::Dashes { points, color, width } => writeln!(
            out,
            "<polyline points=\"{}\" fill=\"none\" stroke-width=\"{width:.2}\" stroke-dasharray=\"{} {}\" stroke={}/>",
            places(points),
            super::DASH,
            super::DASH_GAP,
            paint("stroke", *color)
        ),
        Element::Polygon { points, color } => {
            writeln!(out, "<polygon points=\"{}\" fill={}/>", places(points), paint("fill", *color))
        }
        Element::Text { at, anchor, text, size, color, figures } => {
            let horizontal = match anchor.x() {
                Align::Min => "start",
                Align::Center => "middle",
                Align::Max => "end",
            };
            // Text stands on its base line: about a third of its size below its middle.
            let down = match anchor.y() {
                Align::Min => size * 0.85,
                Align::Center => size * 0.35,
                Align::Max => -size * 0.2,
            };
            let family = if *figures { "monospace" } else { "sans-serif" };
            writeln!(
                out,
                "<text x=\"{:.2}\" y=\"{:.2}\" font-family=\"{family}\" font-size=\"{size:.1}\" text-anchor=\"{horizontal}\" fill={}>{}</text>",
                at.x,
                at.y + down,
                paint("fill", *color),
                escaped(text)
            )
        }
    };
}

fn places(points: &[Pos2]) -> String {
    let mut out = String::with_capacity(points.len() * 14);
    for point in points {
        let _ = write!(out, "{:.2},{:.2} ", point.x, point.y);
    }
    out.truncate(out.trim_end().len());
    out
}

/// A colour as the value of an attribute, with its opacity as another where it has one.
fn paint(attribute: &str, color: Color32) -> String {
    let [r, g, b, a] = color.to_srgba_unmultiplied();
    let solid = format!("\"#{r:02x}{g:02x}{b:02x}\"");
    if a == 255 { solid } else { format!("{solid} {attribute}-opacity=\"{:.3}\"", f32::from(a) / 255.0) }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use egui::{Align2, pos2};

    use super::super::Layer;
    use super::*;

    #[test]
    fn shapes_are_written_with_their_colours_and_words_are_escaped() {
        let place = Rect::from_min_max(pos2(0.0, 0.0), pos2(100.0, 50.0));
        let text = Element::Text {
            at: pos2(10.0, 20.0),
            anchor: Align2::RIGHT_CENTER,
            text: "a < b & \"c\"".to_owned(),
            size: 10.0,
            color: Color32::WHITE,
            figures: true,
        };
        let line = Element::Line {
            points: vec![pos2(0.0, 0.0), pos2(1.0, 2.0)],
            color: Color32::from_rgb(1, 2, 3),
            width: 1.5,
        };
        let picture = vec![Layer { clip: place, elements: vec![line, text] }];
        let svg = svg(&picture, place, Color32::BLACK, "run <1>");
        assert!(svg.starts_with("<svg xmlns=") && svg.ends_with("</svg>\n"), "{svg}");
        assert!(svg.contains("<title>run &lt;1&gt;</title>"), "{svg}");
        assert!(
            svg.contains("points=\"0.00,0.00 1.00,2.00\"") && svg.contains("stroke=\"#010203\""),
            "{svg}"
        );
        assert!(
            svg.contains("text-anchor=\"end\"") && svg.contains("a &lt; b &amp; &quot;c&quot;</text>"),
            "{svg}"
        );
        assert_eq!(svg.matches("<g").count(), svg.matches("</g>").count());
    }

    #[test]
    fn a_faint_colour_keeps_its_opacity() {
        let faint = paint("stroke", Color32::from_rgba_unmultiplied(255, 0, 0, 128));
        assert!(faint.starts_with("\"#ff0000\" stroke-opacity=\"0.50"), "{faint}");
    }
}
