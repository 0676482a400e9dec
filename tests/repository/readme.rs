//! The README shows the code that runs.

#[test]
fn the_host_in_the_readme_is_the_example() {
    let readme = include_str!("../../README.md");
    let example = include_str!("../../examples/first_shadow.rs");
    let start = readme.find("```rust\n").unwrap() + "```rust\n".len();
    let end = start + readme[start..].find("\n```\n").unwrap() + 1;
    assert_eq!(&readme[start..end], example);
}
