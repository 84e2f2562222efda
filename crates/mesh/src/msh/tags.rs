//! From Gmsh tags to indices.

/// Finds the index of a tag in a sorted list of distinct tags.
pub(crate) struct TagMap<'a> {
    tags: &'a [u64],
    /// `table[tag - tags[0]]` is the index plus one, or 0; empty when the tags are sparse.
    table: Vec<u32>,
}

impl<'a> TagMap<'a> {
    /// Map over `tags`, sorted and distinct. A direct table when it costs at most 16 times the list.
    pub(crate) fn new(tags: &'a [u64]) -> TagMap<'a> {
        let mut table = Vec::new();
        if let (Some(&first), Some(&last)) = (tags.first(), tags.last()) {
            let span = last - first;
            if span < 32 * tags.len() as u64 && tags.len() < u32::MAX as usize {
                table.resize(span as usize + 1, 0);
                for (i, &tag) in tags.iter().enumerate() {
                    table[(tag - first) as usize] = i as u32 + 1;
                }
            }
        }
        TagMap { tags, table }
    }

    /// Index of `tag`, if it is there.
    pub(crate) fn get(&self, tag: u64) -> Option<usize> {
        if self.table.is_empty() {
            return self.tags.binary_search(&tag).ok();
        }
        let offset = tag.checked_sub(self.tags[0])?;
        let entry = self.table.get(usize::try_from(offset).ok()?)?;
        (*entry as usize).checked_sub(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// If this failed, sparse and dense tags would lead to different meshes.
    #[test]
    fn the_table_and_the_search_agree() {
        for tags in [
            vec![],
            vec![7],
            vec![3, 4, 6],
            vec![1, 1 << 40, u64::MAX],
            (5..500).step_by(31).collect(),
        ] {
            let map = TagMap::new(&tags);
            for probe in [0, 1, 3, 4, 5, 6, 7, 36, 499, 1 << 40, u64::MAX - 1, u64::MAX] {
                assert_eq!(
                    map.get(probe),
                    tags.iter().position(|&t| t == probe),
                    "{probe} in {tags:?}"
                );
            }
        }
    }
}
