//! The lines of an OBJ file as statements.

use std::borrow::Cow;
use std::fmt;

/// One statement and the line of the file on which it begins, from 1.
#[derive(Clone, Debug)]
pub struct Statement<'a> {
    line: usize,
    text: Cow<'a, str>,
}

impl Statement<'_> {
    /// What it is: `v`, `f` and so on.
    pub fn keyword(&self) -> &str {
        self.text.split_whitespace().next().unwrap_or_default()
    }

    /// What follows the keyword, as one.
    pub fn rest(&self) -> &str {
        let text = self.text.trim();
        text[self.keyword().len()..].trim()
    }

    /// What follows the keyword, word by word.
    pub fn words(&self) -> impl Iterator<Item = &str> {
        self.text.split_whitespace().skip(1)
    }
}

/// As an error names it: the line and how it begins.
impl fmt::Display for Statement<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const SHOWN: usize = 60;
        let text = self.text.trim();
        let shown: String = text.chars().take(SHOWN).collect();
        let dots = if shown.len() < text.len() { "..." } else { "" };
        write!(f, "line {}, {:?}", self.line, shown + dots)
    }
}

/// Text of any encoding that has ASCII as its lower half: UTF-8, or else taken for Latin-1, which can
/// spoil a name and nothing else.
pub fn decoded(bytes: Vec<u8>) -> String {
    let text = String::from_utf8(bytes)
        .unwrap_or_else(|error| error.as_bytes().iter().map(|&byte| byte as char).collect());
    match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_owned(),
        None => text,
    }
}

/// The statements of a file in order: without comments and empty lines, with those put together that end
/// in a backslash.
pub fn statements(text: &str) -> impl Iterator<Item = Statement<'_>> {
    let mut lines = Lines {
        rest: text,
        line: 0,
    };
    std::iter::from_fn(move || {
        loop {
            let (line, first) = lines.next()?;
            let mut text = Cow::Borrowed(first);
            while let Some(part) = text.strip_suffix('\\') {
                let (_, more) = lines.next().unwrap_or_default();
                text = Cow::Owned(format!("{part} {more}"));
            }
            if !text.trim().is_empty() {
                return Some(Statement { line, text });
            }
        }
    })
}

/// Lines with their numbers from 1, without comments, ended as any system ends them: by a line feed, a
/// carriage return or both.
struct Lines<'a> {
    rest: &'a str,
    line: usize,
}

impl<'a> Iterator for Lines<'a> {
    type Item = (usize, &'a str);

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let end = self.rest.find(['\n', '\r']).unwrap_or(self.rest.len());
        let (line, tail) = self.rest.split_at(end);
        let width = match tail.starts_with("\r\n") {
            true => 2,
            false => tail.len().min(1),
        };
        self.rest = &tail[width..];
        self.line += 1;
        let said = line.split('#').next().unwrap_or_default();
        Some((self.line, said.trim_end()))
    }
}
