use std::fmt;
use std::ops::Index;

use super::SurfaceTag;

/// The tags of a mesh's triangles, by triangle id. Reads as a slice does: it is indexed, iterated, and has a length.
///
/// Meshes have few different tags, so a triangle takes a byte. Once a mesh has had more than 256 different ones, it
/// takes eight.
///
/// ```
/// use clamber_surface::mesh::{SurfaceKind, SurfaceTag, SurfaceTags};
///
/// let fur = SurfaceTag::new(SurfaceKind::Fur);
/// let tags: SurfaceTags = [SurfaceTag::default(), fur, fur].into_iter().collect();
/// assert_eq!(tags[1], fur);
/// assert_eq!(tags.iter().filter(|tag| **tag == fur).count(), 2);
/// ```
#[derive(Clone)]
pub struct SurfaceTags(Kept);

#[derive(Clone)]
enum Kept {
    /// Different tags, in the order in which they came up, and the place of each triangle's tag among them. A tag stays
    /// there when its last triangle gets another one.
    Few {
        table: Vec<SurfaceTag>,
        places: Vec<u8>,
    },
    Many(Vec<SurfaceTag>),
}

impl SurfaceTags {
    /// Number of triangles.
    pub fn len(&self) -> usize {
        match &self.0 {
            Kept::Few { places, .. } => places.len(),
            Kept::Many(tags) => tags.len(),
        }
    }

    /// True if there are no triangles.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The tag at an index; `None` beyond the last triangle.
    pub fn get(&self, index: usize) -> Option<&SurfaceTag> {
        match &self.0 {
            Kept::Few { table, places } => Some(&table[usize::from(*places.get(index)?)]),
            Kept::Many(tags) => tags.get(index),
        }
    }

    /// The tags, by triangle id.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &SurfaceTag> + Clone {
        // Every index below the length has a tag.
        (0..self.len()).map(|index| &self[index])
    }

    /// True if one of the triangles has this tag.
    pub fn contains(&self, tag: &SurfaceTag) -> bool {
        self.iter().any(|other| other == tag)
    }

    /// The tags as a list.
    pub fn to_vec(&self) -> Vec<SurfaceTag> {
        self.iter().copied().collect()
    }

    /// Adds the tag of another triangle.
    pub(super) fn push(&mut self, tag: SurfaceTag) {
        let place = self.place_of(tag);
        match (&mut self.0, place) {
            (Kept::Few { places, .. }, Some(place)) => places.push(place),
            (Kept::Many(tags), _) => tags.push(tag),
            // A tag without a place: there are many different tags.
            (Kept::Few { .. }, None) => {}
        }
    }

    /// Replaces a triangle's tag.
    ///
    /// # Panics
    /// If there is no such triangle.
    pub(super) fn set(&mut self, index: usize, tag: SurfaceTag) {
        let place = self.place_of(tag);
        match (&mut self.0, place) {
            (Kept::Few { places, .. }, Some(place)) => places[index] = place,
            (Kept::Many(tags), _) => tags[index] = tag,
            (Kept::Few { .. }, None) => {}
        }
    }

    /// The place of a tag in the table, which grows if necessary. `None` if there are many tags, maybe from now on.
    fn place_of(&mut self, tag: SurfaceTag) -> Option<u8> {
        let Kept::Few { table, .. } = &mut self.0 else {
            return None;
        };
        let known = table.iter().position(|other| *other == tag);
        let place = known.unwrap_or(table.len());
        let Ok(found) = u8::try_from(place) else {
            self.0 = Kept::Many(self.to_vec());
            return None;
        };
        if known.is_none() {
            table.push(tag);
        }
        Some(found)
    }

    /// Size of the arrays in bytes.
    pub(super) fn memory(&self) -> usize {
        match &self.0 {
            Kept::Few { table, places } => size_of_val(&table[..]) + size_of_val(&places[..]),
            Kept::Many(tags) => size_of_val(&tags[..]),
        }
    }
}

impl Default for SurfaceTags {
    fn default() -> Self {
        Self(Kept::Few {
            table: Vec::new(),
            places: Vec::new(),
        })
    }
}

impl Index<usize> for SurfaceTags {
    type Output = SurfaceTag;

    fn index(&self, index: usize) -> &SurfaceTag {
        match &self.0 {
            Kept::Few { table, places } => &table[usize::from(places[index])],
            Kept::Many(tags) => &tags[index],
        }
    }
}

/// As a list of tags.
impl fmt::Debug for SurfaceTags {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

/// Equal if each triangle has the same tag.
impl PartialEq for SurfaceTags {
    fn eq(&self, other: &Self) -> bool {
        self.iter().eq(other.iter())
    }
}

impl PartialEq<[SurfaceTag]> for SurfaceTags {
    fn eq(&self, other: &[SurfaceTag]) -> bool {
        self.iter().eq(other)
    }
}

impl FromIterator<SurfaceTag> for SurfaceTags {
    fn from_iter<I: IntoIterator<Item = SurfaceTag>>(tags: I) -> Self {
        let mut all = Self::default();
        tags.into_iter().for_each(|tag| all.push(tag));
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::SurfaceKind;

    fn tag(user: u32) -> SurfaceTag {
        SurfaceTag::new(SurfaceKind::Fur).with_user(user)
    }

    /// Behaves as a plain list under the same operations, with few different tags and with many.
    #[test]
    fn tags_are_those_of_a_plain_list() {
        let mut rng = fastrand::Rng::with_seed(17);
        for different in [1, 3, 255, 256, 257, 5_000] {
            let (mut tags, mut plain) = (SurfaceTags::default(), Vec::new());
            for step in 0..3_000 {
                let new = tag(rng.u32(0..different));
                if plain.is_empty() || rng.bool() {
                    tags.push(new);
                    plain.push(new);
                } else {
                    let index = rng.usize(0..plain.len());
                    tags.set(index, new);
                    plain[index] = new;
                }
                if step % 500 == 0 {
                    assert_eq!(tags, plain[..]);
                }
            }
            assert_eq!(tags, plain[..]);
            assert_eq!(tags.to_vec(), plain);
            assert_eq!((tags.len(), tags.is_empty()), (plain.len(), false));
            assert_eq!(tags.get(plain.len()), None);
            assert_eq!(tags, plain.iter().copied().collect::<SurfaceTags>());
            let few = matches!(tags.0, Kept::Few { .. });
            assert_eq!(few, different <= 256, "{different}");
            assert!(!tags.contains(&SurfaceTag::default()));
        }
    }

    #[test]
    fn lists_with_the_same_tags_are_equal_however_they_came_about() {
        let mut turned: SurfaceTags = [tag(2), tag(1)].into_iter().collect();
        turned.set(0, tag(1));
        turned.set(1, tag(2));
        let plain: SurfaceTags = [tag(1), tag(2)].into_iter().collect();
        assert_eq!(turned, plain);
        turned.set(1, tag(3));
        assert_ne!(turned, plain);
    }
}
