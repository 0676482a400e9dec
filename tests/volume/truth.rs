//! What is right, and how many pixels of a picture are not.

use shadows::reference::{Class, Interior, ReferenceImage};

/// Interior pixels of each kind, and those of them that a picture has wrong.
#[derive(Clone, Copy, Debug)]
pub struct Errors {
    pub interior: usize,
    pub lit: usize,
    pub shadowed: usize,
    pub wrong: usize,
}

/// What is right, at the centres and at the samples.
pub struct Truth {
    pub centres: ReferenceImage,
    pub samples: Vec<Vec<Class>>,
}

impl Truth {
    /// Whether an edge of the shadow or of the light's range passes between the samples of a pixel,
    /// unseen by its centre.
    fn is_split(&self, pixel: usize, centre: Class) -> bool {
        self.samples.iter().any(|sample| sample[pixel] != centre)
    }

    /// A pixel is wrong if any of its samples is.
    pub fn errors(&self, picture: &[u8]) -> Errors {
        let reference = &self.centres;
        let truth: Vec<_> = reference.classes().zip(reference.visibility()).collect();
        let wrong = |keep: fn(u8) -> bool| {
            let seen = picture.iter().zip(&truth).enumerate();
            let visible: Vec<u8> = seen
                .map(|(pixel, (&value, &(class, right)))| match keep(value) {
                    _ if self.is_split(pixel, class) => right,
                    true => 255,
                    false => 0,
                })
                .collect();
            reference.compare(&visible, Interior::Screen).unwrap()
        };
        Errors {
            interior: reference.interior_pixels(Interior::Screen).unwrap(),
            lit: reference.count(Class::Lit),
            shadowed: reference.count(Class::Shadowed),
            wrong: wrong(|v| v > 0).false_lit_interior + wrong(|v| v == 255).false_shadow_interior,
        }
    }
}
