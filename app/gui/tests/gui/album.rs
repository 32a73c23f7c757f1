//! Every page of every family: walked at large scales for what is cut or nameless, and drawn.
//!
//! `BRUSHWORK_ALBUM=1 cargo test --workspace --test gui album::` draws each page in three sizes and two themes to `target/album`, and the album
//! that is kept, one size in both themes, to `assets/pictures/album`.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use brushwork_gui::App;
use brushwork_gui::actions;
use brushwork_gui::model::Model;
use brushwork_link::settings::SettingValue;
use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_motion_mind_sim::{Mode, MotionMindConfig};
use brushwork_motorvator::sim_spec::{MotorvatorSpec, library};
use brushwork_motorvator_client::MotorvatorDriver;
use brushwork_plant::machine::Machine;
use brushwork_plant::presets;
use brushwork_suprmotr::sim_spec::SuprMotrSpec;
use brushwork_suprmotr_client::SuprMotrDriver;
use egui::accesskit::Role;
use egui::{Theme, Vec2, ViewportId, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use image::RgbaImage;

use crate::support::alone::{LIMIT, alone};
use crate::support::bench::Bench;
use crate::support::one::One;
use crate::support::palette::Palette;
use crate::support::words::{self, Window};

const KEPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/pictures/album");
const INDEX: &str = "index.md";
/// What an album may take in all, so that it can be kept.
const MOST_BYTES: u64 = 8 << 20;

const USUAL: Vec2 = vec2(1280.0, 800.0);
const SIZES: [Vec2; 3] = [USUAL, vec2(1024.0, 700.0), vec2(1920.0, 1080.0)];
const THEMES: [(Theme, &str); 2] = [(Theme::Dark, "dark"), (Theme::Light, "light")];
/// Displays whose scale leaves little room: their pixels, and the scale.
const SCALED: [(Vec2, f32); 2] = [(vec2(1024.0, 700.0), 1.5), (vec2(1920.0, 1080.0), 2.0)];
/// Frames until a changed size is settled.
const FRAMES: usize = 4;
/// Colours of a kept picture.
const COLOURS: usize = 96;
/// What has to be in view on each page.
const ALWAYS: [&str; 3] = ["Stop All", "File", "Help"];

/// A window that is led through its pages.
trait Led {
    fn window(&mut self) -> &mut Window;
    fn let_pass(&mut self, milliseconds: u64);

    fn model(&mut self) -> &mut Model {
        let app: &mut Option<App> = self.window().state_mut();
        &mut app.as_mut().expect("the first frame made it").model
    }

    /// Clicks a button by its label.
    #[track_caller]
    fn go(&mut self, label: &str) {
        let is_text = |role| matches!(role, Role::Label | Role::Heading | Role::Status);
        let window = self.window();
        let mut found =
            window.query_all_by_label(label).filter(|node| !is_text(node.accesskit_node().role()));
        let node = found.next().unwrap_or_else(|| panic!("nothing to press reads {label:?}"));
        node.scroll_to_me();
        drop(found);
        self.let_pass(400);
        let window = self.window();
        let mut found =
            window.query_all_by_label(label).filter(|node| !is_text(node.accesskit_node().role()));
        found.next().expect("it was there").click();
        drop(found);
        self.let_pass(600);
    }
}

impl Led for Bench {
    fn window(&mut self) -> &mut Window {
        &mut self.harness
    }

    fn let_pass(&mut self, milliseconds: u64) {
        self.pass_ms(milliseconds);
    }
}

impl<M: Machine + Send + 'static> Led for One<M> {
    fn window(&mut self) -> &mut Window {
        &mut self.harness
    }

    fn let_pass(&mut self, milliseconds: u64) {
        self.pass_ms(milliseconds);
    }
}

/// What is done with each page.
struct Walk {
    family: &'static str,
    pages: Vec<String>,
    troubles: Vec<String>,
    draws: bool,
}

impl Walk {
    fn of(family: &'static str) -> Self {
        let draws = std::env::var_os("BRUSHWORK_ALBUM").is_some();
        Self { family, pages: Vec::new(), troubles: Vec::new(), draws }
    }

    /// Looks at the page that is open.
    fn page(&mut self, led: &mut dyn Led, title: &str) {
        let name = format!("{}-{:02}-{}", self.family, self.pages.len() + 1, slug(title));
        let mut found: BTreeSet<String> = BTreeSet::new();
        for trouble in [words::without_a_name(led.window()), words::without_a_state(led.window())].concat() {
            found.insert(format!("says nothing: {trouble}"));
        }
        for (size, scale) in SCALED {
            show(led, size, scale);
            let window = led.window();
            let scaled = [words::cut(window), words::outside(window, &ALWAYS)].concat();
            found.extend(scaled.into_iter().map(|trouble| format!("at {:.0} %: {trouble}", scale * 100.0)));
        }
        self.troubles.extend(found.into_iter().map(|trouble| format!("{name}: {trouble}")));
        if self.draws {
            draw(led, &name);
        }
        show(led, USUAL, 1.0);
        self.pages.push(name);
    }

    /// Every screen of the connected unit, with each tab.
    fn screens(&mut self, led: &mut dyn Led) {
        for screen in led.model().front.screens() {
            let family = led.model().front.family();
            let title = family.title(screen);
            led.go(title);
            led.let_pass(1500);
            self.page(led, title);
            for tab in family.tabs(screen) {
                if led.model().front.open_tab(screen) != Some(*tab) {
                    led.model().front.drawers.press(screen, *tab);
                    led.let_pass(600);
                }
                self.page(led, &format!("{title} {}", tab.title(screen)));
            }
        }
    }

    /// The panels and help pages that a menu opens, each closed again.
    fn opened_by_menus(&mut self, led: &mut dyn Led) {
        let titles: Vec<&str> = actions::all()
            .filter(|action| action.place.menu == actions::Menu::Help)
            .map(|action| action.title)
            .chain(["Traffic", "Simulated World"])
            .collect();
        for title in titles {
            let action = actions::all().find(|action| action.title == title).expect("it is in the table");
            if (action.ready)(led.model()).is_err() {
                continue;
            }
            for is_open in [true, false] {
                led.go(action.place.menu.title());
                let window = led.window();
                let is_item = |role| matches!(role, Role::MenuItem | Role::MenuItemCheckBox);
                let mut items =
                    window.query_all_by_label(title).filter(|node| is_item(node.accesskit_node().role()));
                items.next().expect("it is in its menu").click();
                drop(items);
                led.let_pass(600);
                if is_open {
                    self.page(led, title);
                }
                if action.is_on.is_none() {
                    led.window().key_press(egui::Key::Escape);
                    led.let_pass(400);
                    break;
                }
            }
        }
    }

    fn end(self) {
        assert!(self.pages.len() > 5, "{:?}", self.pages);
        if self.draws {
            write_index();
        }
        let kept = kept_pages();
        let missing: Vec<_> = self.pages.iter().filter(|page| !kept.contains(*page)).collect();
        assert!(missing.is_empty(), "the kept album lacks {missing:?}");
        let gone: Vec<_> = kept
            .iter()
            .filter(|page| page.starts_with(&format!("{}-", self.family)) && !self.pages.contains(page))
            .collect();
        assert!(gone.is_empty(), "the kept album has {gone:?}, which are no pages any more");
        assert!(self.troubles.is_empty(), "{} troubles:\n{}", self.troubles.len(), self.troubles.join("\n"));
    }
}

fn slug(title: &str) -> String {
    let lower = title.to_lowercase();
    let parts = lower.split(|letter: char| !letter.is_ascii_alphanumeric()).filter(|part| !part.is_empty());
    parts.collect::<Vec<_>>().join("-")
}

/// On a display of so many pixels with so large a scale: the window's points follow from its zoom, as the system tells them.
fn show(led: &mut dyn Led, pixels: Vec2, scale: f32) {
    for _ in 0..FRAMES {
        let window = led.window();
        let zoom = window.ctx.zoom_factor();
        if let Some(root) = window.input_mut().viewports.get_mut(&ViewportId::ROOT) {
            root.native_pixels_per_point = Some(scale);
        }
        window.set_size(pixels / (scale * zoom));
        led.let_pass(100);
    }
}

fn album_folder() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    target.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target")).join("album")
}

/// Draws the page in each size and theme.
fn draw(led: &mut dyn Led, name: &str) {
    led.window().set_render_cursor(false);
    for size in SIZES {
        for (theme, word) in THEMES {
            led.model().appearance.theme = theme.into();
            show(led, size, 1.0);
            let picture = led.window().render().expect("a picture");
            let all = album_folder().join(format!("{name}-{}x{}-{word}.png", size.x, size.y));
            write(&picture, &all);
            if size == USUAL {
                write(&picture, &Path::new(KEPT).join(format!("{name}-{word}.png")));
            }
        }
    }
    led.model().appearance.theme = Theme::Dark.into();
}

/// With a palette.
fn write(picture: &RgbaImage, path: &Path) {
    let palette = Palette::of([picture], COLOURS);
    let folder = path.parent().expect("it is in a folder");
    fs::create_dir_all(folder).expect("the folder can be made");
    let file = BufWriter::new(File::create(path).expect("it can be written"));
    let mut encoder = png::Encoder::new(file, picture.width(), picture.height());
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette.bytes());
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header().expect("it can be written");
    writer.write_image_data(&palette.indices(picture)).expect("it can be written");
}

/// The pages of which the kept album has a picture in both themes.
fn kept_pages() -> BTreeSet<String> {
    let entries = fs::read_dir(KEPT).expect("the album is kept");
    let names: BTreeSet<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    let pages = names.iter().filter_map(|name| name.strip_suffix("-dark.png"));
    pages.filter(|page| names.contains(&format!("{page}-light.png"))).map(str::to_owned).collect()
}

fn index() -> String {
    let mut text = String::from(
        "# Album\n\nEvery page of the window at 1280 by 800, dark and light, as `CONTRIBUTING.md` says how to draw it anew.\n",
    );
    let mut family = String::new();
    for page in kept_pages() {
        let mut parts = page.splitn(3, '-');
        let (of, number, title) = (parts.next(), parts.next(), parts.next());
        let (Some(of), Some(_), Some(title)) = (of, number, title) else { continue };
        if of != family {
            of.clone_into(&mut family);
            text += &format!("\n## {of}\n\n");
        }
        text +=
            &format!("- {}: [dark]({page}-dark.png), [light]({page}-light.png)\n", title.replace('-', " "));
    }
    text
}

fn write_index() {
    fs::write(Path::new(KEPT).join(INDEX), index()).expect("it can be written");
}

#[test]
fn the_kept_album_is_small_and_its_index_names_each_page() {
    let size = |name: String| fs::metadata(Path::new(KEPT).join(name)).expect("it is there").len();
    let names =
        kept_pages().into_iter().flat_map(|page| ["dark", "light"].map(|word| format!("{page}-{word}.png")));
    let bytes: u64 = names.map(size).sum();
    assert!(bytes > 100_000 && bytes < MOST_BYTES, "{bytes} bytes");
    let kept = fs::read_to_string(Path::new(KEPT).join(INDEX)).expect("it is kept").replace("\r\n", "\n");
    assert_eq!(kept, index());
}

/// An MCP266 with the motor of the examples on both sides.
fn mcp266() -> Controller {
    let axis = presets::lookup("small-gearmotor").expect("a preset");
    let default = ControllerConfig::default();
    let world = presets::world_of(axis, axis, default.model.pins.len());
    Controller::new(ControllerConfig { world, ..default }).expect("the preset is sound")
}

#[test]
fn every_page_of_an_mcp_is_whole_at_large_scales() {
    let mut walk = Walk::of("mcp");
    let mut bench = Bench::of(mcp266());
    bench.pass_ms(500);
    walk.page(&mut bench, "Start");
    bench.connect();
    bench.pass_ms(4000);
    walk.screens(&mut bench);
    bench.go("General Settings");
    for section in ["Voltage limits", "Recipes", "DIN4/AN4/P4", "Conflicts"] {
        bench.go(&format!("Section {section}"));
        walk.page(&mut bench, section);
    }
    let max_volts = SettingValue::Number(33.5);
    let unit = bench.model().front.settings.unit_mut().expect("it was read");
    unit.set("limits.main_battery.max_volts", max_volts);
    bench.pass_ms(200);
    for sheet in [
        "Write settings",
        "Save to EEPROM",
        "Default settings",
        "Open profile",
        "Compare settings",
        "Backups",
        "Copy motor",
    ] {
        bench.go(sheet);
        walk.page(&mut bench, sheet);
        bench.go("Back");
    }
    walk.opened_by_menus(&mut bench);
    walk.end();
}

#[test]
fn every_page_of_a_motion_mind_is_whole_at_large_scales() {
    let mut walk = Walk::of("motion_mind");
    let mut bench = Bench::with_minds(vec![MotionMindConfig::new(Mode::SerialPid)]);
    bench.pass_ms(200);
    bench.choose("Simulated model", "Motion Mind 3");
    bench.connect();
    bench.pass_ms(4000);
    walk.screens(&mut bench);
    walk.end();
}

#[test]
fn every_page_of_a_suprmotr_is_whole_at_large_scales() {
    alone("album::every_page_of_a_suprmotr_is_whole_at_large_scales", LIMIT, || {
        let mut walk = Walk::of("suprmotr");
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let spec = SuprMotrSpec::parse("suprmotr-v9,seed=0").expect("it is a board");
        let bus = spec.bus().expect("the preset is sound");
        let window = (&SuprMotrDriver as _, &brushwork_gui::suprmotr::SuprMotr as _);
        let mut bench = One::new(&folder, window, bus, "sim:suprmotr-v9");
        bench.pass_ms(500);
        bench.app().open("sim:suprmotr-v9");
        bench.pass_ms(5000);
        walk.screens(&mut bench);
        walk.end();
    });
}

#[test]
fn every_page_of_a_motorvator_is_whole_at_large_scales() {
    alone("album::every_page_of_a_motorvator_is_whole_at_large_scales", LIMIT, || {
        let mut walk = Walk::of("motorvator");
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let spec = MotorvatorSpec::parse("motorvator-3,seed=0").expect("it is a board");
        let board = spec.board(library()).expect("the preset is sound");
        let window = (&MotorvatorDriver as _, &brushwork_gui::motorvator::Motorvator as _);
        let mut bench = One::new(&folder, window, board, "sim:motorvator-3");
        bench.app().open("sim:motorvator-3");
        bench.pass_ms(4000);
        walk.screens(&mut bench);
        walk.end();
    });
}
