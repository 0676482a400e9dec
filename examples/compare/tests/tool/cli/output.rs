//! Where results and words go: places that cannot be written, readers that leave.

use std::collections::BTreeSet;
use std::fs;
use std::io::Read as _;
use std::process::{Command, Stdio};

use crate::{COUNTS, SMALL, Scratch, binary, compare, host};

/// Every mode, small enough to be waited for where it is not refused.
const MODES: [&[&str]; 6] = [
    &SMALL,
    &[
        "--sweep",
        "--size",
        "16x9",
        "--frames",
        "1",
        "--technique",
        "volume",
    ],
    &["--hard-cases", "--rounds", "1"],
    &[
        "--temporal",
        "16x9",
        "--steps",
        "1",
        "--technique",
        "volume",
    ],
    &["--growth", "1", "--frames", "1"],
    &["--cost", COUNTS, "--size", "16x9", "--face", "16"],
];

#[test]
fn a_place_where_nothing_can_be_written_is_refused_before_the_work() {
    let scratch = Scratch::new("no-place");
    fs::write(scratch.path("file"), "mine").unwrap();
    let mut places = vec![scratch.path("file/out")];
    // Too long a name for any file system, where the file in the way shows without trying.
    places.push(scratch.path(&"long".repeat(100)));
    if cfg!(target_os = "linux") {
        places.push("/proc/shadows/out".into());
    }
    for mode in MODES {
        for place in &places {
            // Work would begin with the adapter, of which there is none.
            let nowhere = ["--adapter", "no such adapter"];
            let output = compare(&[mode, &nowhere, &["--out", place]].concat());
            let told = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{mode:?}: {told}");
            assert!(told.contains("another --out"), "{mode:?}: {told}");
            assert!(!told.contains("no such adapter"), "{mode:?}: {told}");
        }
        // And where there is a place, the adapter is what is missing, and the place is not made.
        let out = scratch.path("made/for/it");
        let output = compare(&[mode, &["--adapter", "no such adapter", "--out", &out]].concat());
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(told.contains("no such adapter"), "{mode:?}: {told}");
    }
    assert_eq!(scratch.files(""), BTreeSet::from(["file".to_owned()]));
}

/// Whether a pipe's end is still held by its reader.
#[derive(Clone, Copy, PartialEq)]
enum Reader {
    Stays,
    Leaves,
}

/// Exit code and what was written to the standard error.
fn with_readers(args: &[&str], out: Reader, err: Reader) -> (Option<i32>, String) {
    let mut child = Command::new(binary())
        .args(args)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let keep_out = child.stdout.take().filter(|_| out == Reader::Stays);
    let keep_err = child.stderr.take().filter(|_| err == Reader::Stays);
    let mut told = String::new();
    if let Some(mut pipe) = keep_err {
        pipe.read_to_string(&mut told).unwrap();
    }
    let mut said = String::new();
    if let Some(mut pipe) = keep_out {
        pipe.read_to_string(&mut said).unwrap();
        assert!(said.lines().count() > 2, "{said}");
    }
    (child.wait().unwrap().code(), told)
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    if host::gpu::Gpu::for_test().is_none() {
        return;
    }
    let scratch = Scratch::new("pipe");
    for (out, err) in [
        (Reader::Stays, Reader::Stays),
        (Reader::Leaves, Reader::Stays),
        (Reader::Stays, Reader::Leaves),
        (Reader::Leaves, Reader::Leaves),
    ] {
        let place = scratch.path("out");
        let (code, told) = with_readers(&[&SMALL[..], &["--out", &place]].concat(), out, err);
        assert_eq!(code, Some(0), "{told}");
        assert!(!told.contains("panicked"), "{told}");
        assert!(scratch.files("out").contains("report.json"));
        fs::remove_dir_all(place).unwrap();
    }
}

#[test]
fn a_mistake_that_nobody_reads_of_is_still_one() {
    for args in [&["--nonsense"][..], &["--scene", "none such.obj"]] {
        let (code, _) = with_readers(args, Reader::Leaves, Reader::Leaves);
        assert_eq!(code, Some(2), "{args:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn an_output_that_is_full_is_an_error() {
    if host::gpu::Gpu::for_test().is_none() {
        return;
    }
    let scratch = Scratch::new("full");
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let out = scratch.path("out");
    let output = Command::new(binary())
        .args([&SMALL[..], &["--out", &out]].concat())
        .stdout(full)
        .output();
    let output = output.unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(
        told.contains("cannot write to the standard output"),
        "{told}"
    );
}
