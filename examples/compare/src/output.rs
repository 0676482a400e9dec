//! The files of a run: all of them, or none.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};
use shadows::reference::Verdict;

use crate::lamps::Truth;
use crate::measure::Measured;
use host::image::{grey_png, luma, rgb_png};
use host::ply::write_ply;
use host::scene::Scene;

/// A file's name and content.
pub struct File {
    name: String,
    content: Vec<u8>,
}

impl File {
    /// A file of a directory of results.
    pub fn new(name: impl Into<String>, content: impl Into<Vec<u8>>) -> Self {
        Self {
            name: name.into(),
            content: content.into(),
        }
    }
}

/// Everything about one scene.
pub struct Results {
    pub dir: PathBuf,
    pub files: Vec<File>,
    /// The file to read first.
    pub report: &'static str,
    /// For the terminal.
    pub summary: String,
    /// Written as scene.ply.
    pub export: Option<Scene>,
}

/// The pictures of a scene.
///
/// # Errors
/// If one cannot be encoded.
pub fn pictures(size: [u32; 2], truth: &Truth, measured: &[Measured]) -> Result<Vec<File>> {
    let mut files = vec![
        File::new(
            "reference.visibility.png",
            grey_png(size, &truth.visibility())?,
        ),
        File::new("coverage.png", grey_png(size, &truth.coverage())?),
    ];
    for technique in measured {
        let name = &technique.technique.name;
        let picture = &technique.picture;
        let errors = error_picture(&picture.shaded, &technique.error.verdicts);
        files.extend([
            File::new(
                format!("{name}.visibility.png"),
                grey_png(size, &picture.visibility)?,
            ),
            File::new(
                format!("{name}.shaded.png"),
                rgb_png(size, &picture.shaded)?,
            ),
            File::new(format!("{name}.error.png"), rgb_png(size, &errors)?),
        ]);
    }
    Ok(files)
}

/// Wrong pixels in colour over the scene in dark grey.
fn error_picture(shaded: &[[u8; 3]], verdicts: &[Verdict]) -> Vec<[u8; 3]> {
    let pixels = shaded.iter().zip(verdicts);
    pixels
        .map(|(&color, verdict)| match verdict {
            Verdict::FalseLit | Verdict::FalseLitInterior => [255, 40, 30],
            Verdict::FalseShadow | Verdict::FalseShadowInterior => [60, 130, 255],
            Verdict::Right | Verdict::NotCounted => [luma(color) / 2; 3],
        })
        .collect()
}

/// Whether results can be written to a directory: by making it, and a file in it, and taking both back.
///
/// # Errors
/// What is in the way, before any work is done.
pub fn check(dir: &Path) -> Result<()> {
    for place in dir.ancestors().filter(|place| place.exists()) {
        if !place.is_dir() {
            bail!("{} is no directory; pass another --out", place.display());
        }
    }
    let trial = Results {
        dir: dir.into(),
        files: vec![File::new("trial", "")],
        report: "",
        summary: String::new(),
        export: None,
    };
    Staged::new(&trial).context("pass another --out").map(drop)
}

/// Writes the results of all scenes. Each file appears in its place only when all are complete;
/// other files there are left alone.
///
/// # Errors
/// The file or directory that could not be written.
pub fn write_all(results: &[Results]) -> Result<()> {
    let staged: Result<Vec<Staged>> = results.iter().map(Staged::new).collect();
    staged?.iter().try_for_each(Staged::publish)
}

/// Writes files of one run, all of them or none.
///
/// # Errors
/// The file or directory that could not be written.
pub fn write(dir: &Path, files: Vec<File>) -> Result<()> {
    write_all(&[Results {
        dir: dir.into(),
        files,
        report: "",
        summary: String::new(),
        export: None,
    }])
}

/// Results in a directory of their own inside the one where they belong; gone when dropped.
struct Staged<'a> {
    stage: PathBuf,
    results: &'a Results,
    /// The outermost directory that had to be made.
    created: Option<PathBuf>,
}

impl<'a> Staged<'a> {
    /// Writes the files where they are not seen yet.
    fn new(results: &'a Results) -> Result<Self> {
        let dir = &results.dir;
        let missing = dir
            .ancestors()
            .filter(|place| !place.as_os_str().is_empty() && !place.exists());
        let staged = Self {
            stage: dir.join(format!(".compare-{}", std::process::id())),
            results,
            created: missing.last().map(Path::to_owned),
        };
        fs::create_dir_all(&staged.stage)
            .with_context(|| format!("cannot make the directory {}", dir.display()))?;
        for file in &results.files {
            let path = staged.stage.join(&file.name);
            fs::write(&path, &file.content)
                .with_context(|| format!("cannot write {}", path.display()))?;
        }
        if let Some(scene) = &results.export {
            let path = staged.stage.join("scene.ply");
            write_ply(&path, scene).with_context(|| format!("cannot write {}", path.display()))?;
        }
        Ok(staged)
    }

    fn publish(&self) -> Result<()> {
        let names = self.results.files.iter().map(|file| file.name.as_str());
        let export = self.results.export.as_ref().map(|_| "scene.ply");
        for name in names.chain(export) {
            let path = self.results.dir.join(name);
            fs::rename(self.stage.join(name), &path)
                .with_context(|| format!("cannot write {}", path.display()))?;
        }
        Ok(())
    }
}

impl Drop for Staged<'_> {
    fn drop(&mut self) {
        // Best effort: there is no one left to tell. A directory made for results that never came
        // goes too; one that holds anything stays, as `remove_dir` refuses it.
        let _ = fs::remove_dir_all(&self.stage);
        if let Some(created) = &self.created {
            let made = self.results.dir.ancestors();
            for dir in made.take_while(|dir| dir.starts_with(created)) {
                let _ = fs::remove_dir(dir);
            }
        }
    }
}
