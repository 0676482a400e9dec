//! What options take, from text.

use std::path::Path;

use shadows::glam::{Vec3, Vec4};

use super::CameraArg;
use host::scene::{self, LightKind, Time};

/// Textures wider than this are refused by many devices (WebGPU's default limit).
pub const MAX_SIDE: u32 = 8192;

pub fn scene_name(text: &str) -> Result<String, String> {
    if is_file(text) || scene::NAMES.contains(&text) {
        return Ok(text.into());
    }
    let names = scene::NAMES.join(", ");
    Err(format!(
        "no such scene; known are {names}, and .obj, .gltf or .glb files"
    ))
}

/// Whether a scene's name is that of a model file.
pub fn is_file(text: &str) -> bool {
    let ending = Path::new(text).extension().and_then(|e| e.to_str());
    ending.is_some_and(|e| {
        ["obj", "gltf", "glb"]
            .iter()
            .any(|known| e.eq_ignore_ascii_case(known))
    })
}

pub fn light(text: &str) -> Result<Vec4, String> {
    let n = numbers(text, 3..=4)?;
    let w = n.get(3).copied().unwrap_or(1.0);
    if w != 0.0 && w != 1.0 {
        return Err(format!(
            "w is {w}; it must be 1 (a point) or 0 (a direction)"
        ));
    }
    let light = Vec4::new(n[0], n[1], n[2], w);
    if light == Vec4::ZERO {
        return Err("a direction cannot be 0,0,0".into());
    }
    Ok(light)
}

pub fn camera(text: &str) -> Result<CameraArg, String> {
    let n = numbers(text, 6..=7)?;
    let eye = Vec3::new(n[0], n[1], n[2]);
    let target = Vec3::new(n[3], n[4], n[5]);
    if eye == target {
        return Err("eye and target are the same point".into());
    }
    if eye.x == target.x && eye.z == target.z {
        return Err("the target is straight above or below the eye; move it sideways".into());
    }
    let fovy = match n.get(6) {
        Some(degrees) if *degrees > 0.0 && *degrees < 180.0 => Some(degrees.to_radians()),
        Some(degrees) => {
            return Err(format!(
                "field of view {degrees} is not between 0 and 180 degrees"
            ));
        }
        None => None,
    };
    Ok(CameraArg { eye, target, fovy })
}

pub fn light_kind(text: &str) -> Result<LightKind, String> {
    match text {
        "point" => Ok(LightKind::Point),
        "spot" => Ok(LightKind::Spot),
        "directional" => Ok(LightKind::Directional),
        _ => Err("it must be point, spot or directional".into()),
    }
}

pub fn time(text: &str) -> Result<Time, String> {
    match text {
        "day" => Ok(Time::Day),
        "night" => Ok(Time::Night),
        _ => Err("it must be day or night".into()),
    }
}

pub fn range(text: &str) -> Result<f32, String> {
    let range = number(text)?;
    if range > 0.0 {
        Ok(range)
    } else {
        Err("it must be above 0".into())
    }
}

pub fn part(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(part) if (0.0..=1.0).contains(&part) => Ok(part),
        _ => Err("it must be a number from 0 to 1".into()),
    }
}

pub fn times(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(times) if times >= 1.0 => Ok(times),
        _ => Err("it must be a number of at least 1".into()),
    }
}

pub fn milliseconds(text: &str) -> Result<f64, String> {
    let number = text
        .strip_suffix("ms")
        .and_then(|number| number.parse().ok());
    let time = number.filter(|time: &f64| time.is_finite() && *time > 0.0);
    time.ok_or_else(|| "it must be milliseconds above 0, such as 2ms or 0.5ms".into())
}

pub fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |s: &str| s.parse().ok().filter(|n| (1..=MAX_SIDE).contains(n));
    let sides = text.split_once(['x', 'X']);
    match sides.map(|(w, h)| (side(w), side(h))) {
        Some((Some(w), Some(h))) => Ok([w, h]),
        _ => Err(format!("expected WIDTHxHEIGHT, each from 1 to {MAX_SIDE}")),
    }
}

fn number(text: &str) -> Result<f32, String> {
    let number: Result<f32, _> = text.trim().parse();
    let number = number.map_err(|_| format!("{text:?} is not a number"))?;
    if number.is_finite() {
        Ok(number)
    } else {
        Err(format!("{text} is not finite"))
    }
}

fn numbers(text: &str, count: std::ops::RangeInclusive<usize>) -> Result<Vec<f32>, String> {
    let numbers: Vec<f32> = text.split(',').map(number).collect::<Result<_, _>>()?;
    if count.contains(&numbers.len()) {
        return Ok(numbers);
    }
    let [least, most] = [count.start(), count.end()];
    Err(format!(
        "expected {least} or {most} numbers, got {}",
        numbers.len()
    ))
}
