//! What holds of the repository rather than of the crate: its pages, their links, what a host is told to
//! depend on, and which Rust that takes. The package leaves this test out.

mod dependencies;
mod features;
mod figures;
mod named;
mod pages;
mod rust_version;

/// The text of a file of the repository.
fn read(path: &str) -> String {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The blocks of a page in one language, without their fences.
fn blocks(page: &str, language: &str) -> Vec<String> {
    let fence = format!("\n```{language}\n");
    let starts = page.split(fence.as_str()).skip(1);
    starts
        .map(|rest| rest.split("\n```").next().unwrap().to_owned())
        .collect()
}
