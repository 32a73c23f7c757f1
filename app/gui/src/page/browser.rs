//! What the page asks of the browser: to keep small files, to download, to let a file be chosen.

use std::cell::RefCell;
use std::io;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use brushwork_core::keep::folder::{DOWNLOADS, KEPT};
use brushwork_link::files::{Shelf, page};
use crossbeam_channel::Sender;
use egui::Context;
use js_sys::{Array, Uint8Array};
use wasm_bindgen::{JsCast as _, JsValue, closure::Closure};
use wasm_bindgen_futures::JsFuture;
use web_sys::{Blob, File, HtmlAnchorElement, HtmlInputElement, Storage, Url};

/// Before the names of what is ours in the browser's storage.
const OURS: &str = "brushwork:";

thread_local! {
    /// The window to wake when a file has come.
    static WINDOW: RefCell<Option<Context>> = const { RefCell::new(None) };
}

/// The window that is woken.
pub fn set_window(ctx: &Context) {
    WINDOW.with(|window| window.replace(Some(ctx.clone())));
}

/// The browser's storage for this page, which has room for some megabytes and lasts; what is written elsewhere is downloaded.
pub struct BrowserShelf;

impl Shelf for BrowserShelf {
    fn put(&self, path: &Path, content: &[u8]) -> io::Result<()> {
        if path.starts_with(DOWNLOADS) {
            return download(path, content).map_err(told);
        }
        let text = std::str::from_utf8(content).map_err(io::Error::other)?;
        let storage = storage().ok_or_else(|| io::Error::other("this browser keeps nothing for the page"))?;
        storage.set_item(&key(path), text).map_err(|error| {
            // Of what can go wrong here there is one thing that its owner can do something about.
            io::Error::new(io::ErrorKind::StorageFull, told(error))
        })
    }

    fn take(&self, path: &Path) {
        if let Some(storage) = storage() {
            // What cannot be taken away is there the next time.
            let _ = storage.remove_item(&key(path));
        }
    }
}

/// What was kept the last time.
pub fn kept() -> Vec<(PathBuf, Vec<u8>)> {
    let Some(storage) = storage() else { return Vec::new() };
    let keys = (0..storage.length().unwrap_or(0)).filter_map(|index| storage.key(index).ok().flatten());
    keys.filter_map(|key| {
        let path = PathBuf::from(key.strip_prefix(OURS)?);
        let text = storage.get_item(&key).ok().flatten()?;
        path.starts_with(KEPT).then(|| (path, text.into_bytes()))
    })
    .collect()
}

fn key(path: &Path) -> String {
    format!("{OURS}{}", path.display())
}

fn storage() -> Option<Storage> {
    web_sys::window()?.local_storage().ok()?
}

fn told(error: JsValue) -> io::Error {
    let error = error.dyn_into::<js_sys::Error>().map(|error| String::from(error.message()));
    io::Error::other(error.unwrap_or_else(|_| "the browser refuses".to_owned()))
}

/// Hands a file to the browser, which saves it as it saves downloads.
fn download(path: &Path, content: &[u8]) -> Result<(), JsValue> {
    let nothing = || JsValue::UNDEFINED;
    let document = web_sys::window().and_then(|window| window.document()).ok_or_else(nothing)?;
    let parts = Array::of1(&Uint8Array::from(content));
    let url = Url::create_object_url_with_blob(&Blob::new_with_u8_array_sequence(&parts)?)?;
    let link = document.create_element("a")?.dyn_into::<HtmlAnchorElement>()?;
    link.set_href(&url);
    link.set_download(&path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default());
    link.click();
    Url::revoke_object_url(&url)
}

/// Lets a file be chosen, or several; they stand among the downloads then, and their paths are sent.
pub fn choose(extensions: &str, several: bool, chosen: Sender<Vec<PathBuf>>) {
    // Without a dialog the sender is dropped, which reads as cancelled.
    let _ = ask(extensions, several, chosen);
}

fn ask(extensions: &str, several: bool, chosen: Sender<Vec<PathBuf>>) -> Result<(), JsValue> {
    let nothing = || JsValue::UNDEFINED;
    let document = web_sys::window().and_then(|window| window.document()).ok_or_else(nothing)?;
    let input = document.create_element("input")?.dyn_into::<HtmlInputElement>()?;
    input.set_type("file");
    let accepted: Vec<String> = extensions.split(',').map(|extension| format!(".{extension}")).collect();
    input.set_accept(&accepted.join(","));
    input.set_multiple(several);
    let asked = Rc::new(input.clone());
    let of_change = chosen.clone();
    let changed = Closure::once_into_js(move || {
        let listed = asked.files();
        let files: Vec<File> =
            listed.iter().flat_map(|list| (0..list.length()).filter_map(|index| list.get(index))).collect();
        wasm_bindgen_futures::spawn_local(async move {
            let mut paths = Vec::new();
            for file in &files {
                paths.extend(bring(file).await);
            }
            answer(&of_change, paths);
        });
    });
    let cancelled = Closure::once_into_js(move || answer(&chosen, Vec::new()));
    input.set_onchange(Some(changed.unchecked_ref()));
    input.set_oncancel(Some(cancelled.unchecked_ref()));
    input.click();
    Ok(())
}

async fn bring(file: &File) -> Option<PathBuf> {
    let content = JsFuture::from(file.array_buffer()).await.ok()?;
    let path = PathBuf::from(DOWNLOADS).join(file.name());
    page().bring(&path, Uint8Array::new(&content).to_vec());
    Some(path)
}

fn answer(chosen: &Sender<Vec<PathBuf>>, paths: Vec<PathBuf>) {
    // The window may have gone on without the answer.
    let _ = chosen.try_send(paths);
    wake_window();
}

/// Has the window drawn although nobody touches it.
pub fn wake_window() {
    WINDOW.with(|window| {
        if let Some(ctx) = &*window.borrow() {
            ctx.request_repaint();
        }
    });
}

/// What stands behind `#open=` in the page's address, as a person would type it.
pub fn target() -> Option<String> {
    let hash = web_sys::window()?.location().hash().ok()?;
    let target = hash.strip_prefix('#')?.split('&').find_map(|part| part.strip_prefix("open="))?;
    js_sys::decode_uri_component(target).ok().map(String::from)
}
