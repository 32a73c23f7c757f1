//! The reference of MCL, section by section, from the tables that the compiler reads; where the manual contradicts itself, too.

use std::sync::OnceLock;

use brushwork_script::mcl::reference::sections;
use egui::{Label, Ui};

use super::list::{Entry, list_ui};
use super::scrolled_ui;
use crate::model::help::Help;

/// One entry of the reference: how it is found, and what it says line by line.
struct Page {
    entry: Entry,
    title: String,
    section: &'static str,
    lines: Vec<String>,
}

pub fn mcl_ui(ui: &mut Ui, help: &mut Help) {
    static PAGES: OnceLock<(Vec<Entry>, Vec<Page>)> = OnceLock::new();
    let (entries, pages) = PAGES.get_or_init(|| {
        let pages = pages();
        let entry = |page: &Page| Entry {
            key: page.entry.key.clone(),
            title: page.entry.title.clone(),
            words: page.entry.words.clone(),
        };
        (pages.iter().map(entry).collect(), pages)
    });
    list_ui(ui, entries, help);
    let chosen = pages.iter().find(|page| Some(page.entry.key.as_str()) == help.entry.as_deref());
    scrolled_ui(ui, |ui| {
        match chosen {
        Some(page) => page_ui(ui, page),
        None => drop(ui.weak("Choose a word at the left. In a syntax line braces stand round what may be left out; they are not typed. \
             Upper and lower case are the same.")),
    }
    });
}

fn pages() -> Vec<Page> {
    let sections = sections().into_iter();
    let of_section = |section: brushwork_script::mcl::reference::Section| {
        let title = section.title;
        section.entries.into_iter().map(move |(name, lines)| Page {
            entry: Entry {
                key: format!("{title} {name}"),
                title: format!("{name}   ({title})"),
                words: format!("{title} {name} {}", lines.join(" ")).to_lowercase(),
            },
            title: name,
            section: title,
            lines,
        })
    };
    sections.flat_map(of_section).collect()
}

fn page_ui(ui: &mut Ui, page: &Page) {
    ui.heading(&page.title);
    ui.weak(page.section);
    ui.add_space(4.0);
    for line in &page.lines {
        ui.add(Label::new(line).wrap());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_entry_of_the_reference_says_something_and_can_be_told_apart() {
        let pages = pages();
        let mut keys: Vec<&str> = pages.iter().map(|page| page.entry.key.as_str()).collect();
        assert!(keys.len() > 150, "{}", keys.len());
        assert!(
            keys.iter().any(|key| key.ends_with("GOSUB")) && keys.iter().any(|key| key.ends_with("SYSTICK"))
        );
        keys.sort_unstable();
        assert!(keys.windows(2).all(|pair| pair[0] != pair[1]), "two entries of one name");
        for page in &pages {
            assert!(
                !page.title.trim().is_empty() && !page.entry.words.trim().is_empty(),
                "{}",
                page.entry.key
            );
        }
    }
}
