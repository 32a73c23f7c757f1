//! `brushwork mcl build`: scripts into images, with what they take of each model.

use crate::messages::CliScriptMessage;
use std::path::{Path, PathBuf};

use brushwork_script::diagnostic::PlacedDiagnostic;
use brushwork_script::image;
use brushwork_script::mcl;
use brushwork_script::program::{Program, ROOMS, Size, limits};
use serde::Serialize;

use super::args::BuildArgs;
use crate::scripts::{Source, is_standard};
use crate::{Exit, NewFile, Output, OutputError, Replace, say};

/// What an image file's name ends with.
pub const EXTENSION: &str = "mcli";

/// What became of one file.
#[derive(Serialize)]
struct Built {
    file: String,
    image: Option<PathBuf>,
    size: Option<Size>,
    models: Vec<Fit>,
    stack: Stack,
    diagnostics: Vec<PlacedDiagnostic>,
}

/// What a running script may have on its stack, on every model.
#[derive(Serialize)]
struct Stack {
    values: usize,
    gosubs: usize,
    /// What models hold is not public.
    assumed: bool,
}

impl Stack {
    const ASSUMED: Self = Self { values: limits::STACK_CELLS, gosubs: limits::CALLS, assumed: true };
}

/// What a program takes of a model.
#[derive(Serialize)]
struct Fit {
    model: &'static str,
    fits: bool,
    ram_bytes: u32,
    ram_bytes_of: u32,
    image_bytes: usize,
    image_bytes_of: usize,
    /// What models hold is not public.
    assumed: bool,
}

#[derive(Serialize)]
struct Report {
    files: Vec<Built>,
}

/// Builds every file that has no error.
pub fn run(args: &BuildArgs, out: &mut Output) -> Result<Exit, Exit> {
    if args.output.is_some() && args.files.len() > 1 {
        return Err(Exit::Usage.saying(CliScriptMessage::OneOutput));
    }
    let mut files = Vec::new();
    let mut exit = Exit::Done;
    for path in &args.files {
        match build(path, args, out) {
            Ok(built) => {
                if built.image.is_none() && exit == Exit::Done {
                    exit = Exit::ScriptWrong;
                }
                files.push(built);
            }
            Err(failed) => exit = failed,
        }
    }
    // An image on standard output stands alone there.
    let is_taken = args.output.as_deref().is_some_and(is_standard);
    let printed = match (is_taken, args.json) {
        (true, _) => Ok(()),
        (false, true) => out.json(&Report { files }),
        (false, false) => {
            files.iter().filter(|file| file.image.is_some()).try_for_each(|file| print(file, out))
        }
    };
    printed?;
    Ok(exit)
}

fn build(path: &Path, args: &BuildArgs, out: &mut Output) -> Result<Built, Exit> {
    let source = Source::read(path).map_err(|error| Exit::Failed.saying(error))?;
    let compiled = mcl::compile(&source.text);
    if !args.json {
        let said = source.rendered(&compiled.diagnostics);
        if !said.is_empty() {
            say(said.trim_end());
        }
    }
    let mut built = Built {
        file: source.name.clone(),
        image: None,
        size: None,
        models: Vec::new(),
        stack: Stack::ASSUMED,
        diagnostics: source.placed(&compiled.diagnostics),
    };
    let Some(program) = &compiled.program else { return Ok(built) };
    let target = target(path, args)?;
    write(&target, path, args.replace, &image::to_file(&image::encode(program)), out)?;
    let size = program.size();
    built.models = fits(program);
    built.size = Some(size);
    built.image = Some(target);
    Ok(built)
}

fn target(path: &Path, args: &BuildArgs) -> Result<PathBuf, Exit> {
    match &args.output {
        Some(output) => Ok(output.clone()),
        None if is_standard(path) => Err(Exit::Usage.saying(CliScriptMessage::NoName)),
        None => Ok(path.with_extension(EXTENSION)),
    }
}

fn write(target: &Path, source: &Path, replace: Replace, bytes: &[u8], out: &mut Output) -> Result<(), Exit> {
    if is_standard(target) {
        return out.bytes(bytes).map_err(Exit::from);
    }
    Ok(NewFile::new(target, replace).apart_from(source).write(bytes)?)
}

fn fits(program: &Program) -> Vec<Fit> {
    let size = program.size();
    let fit = |room: &brushwork_script::program::Room| Fit {
        model: room.model,
        fits: room.takes(&size),
        ram_bytes: size.ram_bytes,
        ram_bytes_of: room.ram_bytes,
        image_bytes: size.image_bytes,
        image_bytes_of: room.image_bytes,
        assumed: true,
    };
    ROOMS.iter().map(fit).collect()
}

fn print(built: &Built, out: &mut Output) -> Result<(), OutputError> {
    let (Some(image), Some(size)) = (&built.image, &built.size) else { return Ok(()) };
    out.line(format!("{} -> {}", built.file, image.display()))?;
    out.line(format!(
        "{} instructions in {} bytes, {} bytes of constants, {} bytes of variables, image of {} bytes",
        size.instructions, size.code_bytes, size.data_bytes, size.ram_bytes, size.image_bytes
    ))?;
    let row = |fit: &Fit| {
        let share = |is: f64, of: f64| format!("{:.1} %", is / of * 100.0);
        vec![
            fit.model.to_owned(),
            if fit.fits { "yes" } else { "NO" }.to_owned(),
            format!("{} of {}", fit.ram_bytes, fit.ram_bytes_of),
            share(f64::from(fit.ram_bytes), f64::from(fit.ram_bytes_of)),
            format!("{} of {}", fit.image_bytes, fit.image_bytes_of),
            share(fit.image_bytes as f64, fit.image_bytes_of as f64),
        ]
    };
    let rows: Vec<Vec<String>> = built.models.iter().map(row).collect();
    out.table(&["MODEL", "FITS", "VARIABLES", "", "IMAGE", ""], &rows)?;
    let Stack { values, gosubs, .. } = built.stack;
    out.line(format!(
        "While it runs: at most {values} values on the stack and {gosubs} GOSUBs within each other."
    ))?;
    out.line("What models hold is not public: the figures after \"of\" and those of the stack are assumed.")
}
