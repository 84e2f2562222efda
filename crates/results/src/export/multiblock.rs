//! A VTK XML multi-block data set (`.vtm`): a tree of named blocks, each leaf a file beside it.
//!
//! Source: VTK File Formats, Kitware, "XML file formats", `vtkMultiBlockDataSet`.

use std::io::{self, Write};

/// A block.
#[derive(Clone, Debug, PartialEq)]
pub enum DataBlock {
    /// A grid in a file: name of the block, and path of the file from the folder of the tree.
    Leaf(String, String),
    /// Blocks under one name.
    Group(String, Vec<DataBlock>),
}

/// Writes the tree of some blocks.
pub fn write(file: &mut dyn Write, blocks: &[DataBlock]) -> io::Result<()> {
    writeln!(
        file,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<vtkMultiBlockDataSet>"
    )?;
    write_blocks(file, blocks)?;
    writeln!(file, "</vtkMultiBlockDataSet>\n</VTKFile>")
}

fn write_blocks(file: &mut dyn Write, blocks: &[DataBlock]) -> io::Result<()> {
    for (index, block) in blocks.iter().enumerate() {
        match block {
            DataBlock::Leaf(name, path) => {
                let (name, path) = (escaped(name), escaped(path));
                writeln!(
                    file,
                    "<DataSet index=\"{index}\" name=\"{name}\" file=\"{path}\"/>"
                )?;
            }
            DataBlock::Group(name, inside) => {
                writeln!(file, "<Block index=\"{index}\" name=\"{}\">", escaped(name))?;
                write_blocks(file, inside)?;
                writeln!(file, "</Block>")?;
            }
        }
    }
    Ok(())
}

/// A text as the value of an attribute.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a viewer would refuse the file of a body whose name has signs of XML.
    #[test]
    fn names_are_escaped_and_blocks_counted_in_their_group() {
        let leaf = |name: &str| DataBlock::Leaf(name.to_string(), "a/b.vtu".to_string());
        let tree = [DataBlock::Group(
            "all".to_string(),
            vec![leaf("a"), leaf("<\"&\">")],
        )];
        let mut text = Vec::new();
        write(&mut text, &tree).unwrap();
        let text = String::from_utf8(text).unwrap();
        let expected = "<Block index=\"0\" name=\"all\">\n<DataSet index=\"0\" name=\"a\" file=\"a/b.vtu\"/>\n\
                        <DataSet index=\"1\" name=\"&lt;&quot;&amp;&quot;&gt;\" file=\"a/b.vtu\"/>\n</Block>\n";
        assert!(text.contains(expected), "{text}");
    }
}
