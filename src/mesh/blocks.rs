//! Edges in blocks, each with the words of facings that its triangles lie in: where those are all
//! alike, no edge of the block is looked at.

use super::MeshKind;
use super::data::MeshData;
use super::planes::LANES;

/// Edges in a block.
pub(crate) const BLOCK: usize = 128;

/// More words than this are dearer to read than the edges.
const MOST_WORDS: usize = 32;

/// What a block of edges depends on.
#[derive(Clone, Copy, Debug)]
struct Block {
    /// Where its words end; they begin where the block before has its end.
    end: u32,
    /// Whether triangles that all face alike leave no boundary in it, so that no edge is open.
    balanced: bool,
    /// Whether its words are listed.
    listed: bool,
}

/// For each block of edges, in the order of edges.
#[derive(Clone, Debug, Default)]
pub(crate) struct EdgeBlocks {
    blocks: Vec<Block>,
    words: Vec<u32>,
}

/// What is known of a block without a look at its edges.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BlockWords<'a> {
    /// Places of the words of facings; `None` where they are too many.
    pub words: Option<&'a [u32]>,
    pub balanced: bool,
}

impl EdgeBlocks {
    pub fn new(mesh: &MeshData, kind: MeshKind) -> Self {
        let mut all = Self::default();
        let mut words = Vec::new();
        for edges in mesh.edges.chunks(BLOCK) {
            words.clear();
            let mut balanced = true;
            for edge in edges {
                let mut sum = 0;
                mesh.for_each_use(edge, kind, |triangle, reversed| {
                    words.push(triangle / LANES as u32);
                    sum += if reversed { -1 } else { 1 };
                });
                balanced &= sum == 0;
            }
            words.sort_unstable();
            words.dedup();
            let listed = words.len() <= MOST_WORDS;
            if listed {
                all.words.extend(&words);
            }
            all.blocks.push(Block {
                // No more than there are triangles' corners, which fit 32 bits.
                end: all.words.len() as u32,
                balanced,
                listed,
            });
        }
        all
    }

    pub fn iter(&self) -> impl Iterator<Item = BlockWords<'_>> {
        let mut begin = 0;
        self.blocks.iter().map(move |block| {
            let end = block.end as usize;
            let words = &self.words[begin..end];
            begin = end;
            BlockWords {
                words: block.listed.then_some(words),
                balanced: block.balanced,
            }
        })
    }
}
