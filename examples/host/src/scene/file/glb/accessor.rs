//! The numbers of a glTF file.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use gltf::accessor::{DataType, Dimensions, Item, Iter};
use gltf::{Accessor, Document, buffer};

/// A file's buffers, and what is read from them.
pub struct Buffers(Vec<buffer::Data>);

impl Buffers {
    /// Reads them all. (Not `gltf::import`: that would load the images too, and names no file.)
    ///
    /// # Errors
    /// The buffer or the file that is missing or too short.
    pub fn read(
        document: &Document,
        base: Option<&Path>,
        mut binary: Option<Vec<u8>>,
    ) -> Result<Self> {
        let mut read = |buffer: buffer::Buffer<'_>| {
            let name = match buffer.source() {
                buffer::Source::Bin => "its binary part".to_owned(),
                buffer::Source::Uri(uri) if uri.starts_with("data:") => {
                    format!("buffer {}", buffer.index())
                }
                buffer::Source::Uri(uri) => {
                    ensure!(is_decodable(uri), "{uri:?} is no name of a file");
                    format!("{uri:?}")
                }
            };
            let data = buffer::Data::from_source_and_blob(buffer.source(), base, &mut binary);
            let data = data.with_context(|| format!("cannot read {name}"))?;
            let (length, there) = (buffer.length(), data.len());
            ensure!(
                there >= length,
                "{name} has {there} bytes, and {length} are promised"
            );
            Ok(data)
        };
        let buffers = document.buffers().map(&mut read);
        let buffers = buffers.collect::<Result<_>>();
        buffers.context("cannot read its buffers").map(Self)
    }

    /// Vectors of floats, or of integers as the accessor says (KHR_mesh_quantization).
    ///
    /// # Errors
    /// If it holds something else, or reaches outside its buffer.
    pub fn floats<const N: usize>(&self, accessor: &Accessor<'_>) -> Result<Vec<[f32; N]>>
    where
        [f32; N]: Item,
        [i8; N]: Item,
        [u8; N]: Item,
        [i16; N]: Item,
        [u16; N]: Item,
    {
        let dimensions = match N {
            3 => Dimensions::Vec3,
            _ => Dimensions::Vec4,
        };
        let kind = accessor.data_type();
        check(accessor, dimensions, kind != DataType::U32)?;
        // Of signed integers, the least stands for -1 too.
        let scaled = |value: f32, most: f32| match accessor.normalized() {
            true => (value / most).max(-1.0),
            false => value,
        };
        match kind {
            DataType::I8 => self.items(accessor, |v: [i8; N]| v.map(|x| scaled(x.into(), 127.0))),
            DataType::U8 => self.items(accessor, |v: [u8; N]| v.map(|x| scaled(x.into(), 255.0))),
            DataType::I16 => self.items(accessor, |v: [i16; N]| {
                v.map(|x| scaled(x.into(), 32_767.0))
            }),
            DataType::U16 => self.items(accessor, |v: [u16; N]| {
                v.map(|x| scaled(x.into(), 65_535.0))
            }),
            DataType::U32 | DataType::F32 => self.items(accessor, |v: [f32; N]| v),
        }
    }

    /// Indices.
    ///
    /// # Errors
    /// As [`floats`](Self::floats).
    pub fn indices(&self, accessor: &Accessor<'_>) -> Result<Vec<u32>> {
        let kind = accessor.data_type();
        let types = [DataType::U8, DataType::U16, DataType::U32];
        check(accessor, Dimensions::Scalar, types.contains(&kind))?;
        match kind {
            DataType::U8 => self.items(accessor, |i: u8| i.into()),
            DataType::U16 => self.items(accessor, |i: u16| i.into()),
            _ => self.items(accessor, |i: u32| i),
        }
    }

    fn items<T: Item, U>(
        &self,
        accessor: &Accessor<'_>,
        convert: impl Fn(T) -> U,
    ) -> Result<Vec<U>> {
        let bytes = |buffer: buffer::Buffer<'_>| self.0.get(buffer.index()).map(|d| d.0.as_slice());
        let items = Iter::<T>::new(accessor.clone(), bytes);
        let items = items
            .with_context(|| format!("accessor {} reaches outside its buffer", accessor.index()))?;
        Ok(items.map(convert).collect())
    }
}

/// What the library would panic at.
fn check(accessor: &Accessor<'_>, dimensions: Dimensions, type_fits: bool) -> Result<()> {
    let index = accessor.index();
    let sparse = accessor.sparse();
    ensure!(
        (1..=u32::MAX as usize).contains(&accessor.count())
            && accessor.dimensions() == dimensions
            && type_fits
            && sparse
                .as_ref()
                .is_none_or(|s| (1..=accessor.count()).contains(&s.count())),
        "accessor {index} has the wrong type or no elements"
    );
    let stride = accessor.view().and_then(|view| view.stride());
    ensure!(
        stride.is_none_or(|stride| stride >= accessor.size()),
        "the elements of accessor {index} overlap"
    );
    let mut places = vec![accessor.offset()];
    let views = sparse.iter().flat_map(|sparse| {
        let (indices, values) = (sparse.indices(), sparse.values());
        places.extend([indices.offset(), values.offset()]);
        [indices.view(), values.view()]
    });
    let views: Vec<buffer::View<'_>> = views.chain(accessor.view()).collect();
    for view in views {
        places.extend([view.offset(), view.length(), view.stride().unwrap_or(0)]);
    }
    // So that no sum of them is too large.
    ensure!(
        places.iter().all(|place| *place <= u32::MAX as usize),
        "accessor {index} reaches outside its buffer"
    );
    Ok(())
}

/// Whether a file's name, with its bytes as `%xx`, is UTF-8, without which the library panics.
fn is_decodable(uri: &str) -> bool {
    let mut parts = uri.split('%');
    let mut bytes: Vec<u8> = parts.next().unwrap_or_default().into();
    for part in parts {
        let code = part
            .get(..2)
            .and_then(|hex| u8::from_str_radix(hex, 16).ok());
        match code {
            Some(byte) => {
                bytes.push(byte);
                bytes.extend(part.bytes().skip(2));
            }
            None => bytes.extend(part.bytes()),
        }
    }
    String::from_utf8(bytes).is_ok()
}
