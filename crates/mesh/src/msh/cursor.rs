//! A place in the bytes of an MSH file, and the numbers that can be read from there.
//!
//! MSH 4.1 has the same fields in its text and binary forms (`int`, `size_t`, `double`); the cursor knows which
//! form it is in, so that one parser serves both. Nothing here can panic or allocate more than the file's size.

use std::path::Path;

use crate::error::{MeshError, Place};

/// How the numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// Words separated by white space.
    Ascii,
    /// 4-byte int, 8-byte double, 4- or 8-byte `size_t`.
    Binary { big_endian: bool, size_bytes: usize },
}

/// Position in a file.
pub(crate) struct Cursor<'a> {
    pub(crate) path: &'a Path,
    data: &'a [u8],
    pos: usize,
    pub(crate) encoding: Encoding,
}

impl<'a> Cursor<'a> {
    pub(crate) fn new(path: &'a Path, data: &'a [u8]) -> Cursor<'a> {
        Cursor {
            path,
            data,
            pos: 0,
            encoding: Encoding::Ascii,
        }
    }

    /// Where the cursor is, for messages. Counting lines costs a pass over the file, paid only on error.
    pub(crate) fn place(&self) -> Place {
        match self.encoding {
            Encoding::Ascii => Place::Line(1 + self.data[..self.pos].iter().filter(|&&b| b == b'\n').count()),
            Encoding::Binary { .. } => Place::Byte(self.pos),
        }
    }

    /// The error that the file does not hold `expected` here.
    pub(crate) fn damaged(&self, expected: &str, found: impl Into<String>) -> MeshError {
        MeshError::Damaged {
            path: self.path.to_path_buf(),
            place: self.place(),
            expected: expected.to_string(),
            found: found.into(),
        }
    }

    /// The error that a count in a header is wrong.
    pub(crate) fn mismatch(&self, what: &'static str, announced: u64, found: impl ToString) -> MeshError {
        MeshError::CountMismatch {
            path: self.path.to_path_buf(),
            place: self.place(),
            what,
            announced,
            found: found.to_string(),
        }
    }

    pub(crate) fn remaining(&self) -> usize {
        self.data.len() - self.pos
    }

    pub(crate) fn skip_white(&mut self) {
        while self.data.get(self.pos).is_some_and(u8::is_ascii_whitespace) {
            self.pos += 1;
        }
    }

    /// The next word, whatever the encoding.
    pub(crate) fn word(&mut self, expected: &str) -> Result<&'a str, MeshError> {
        self.skip_white();
        let rest = &self.data[self.pos..];
        let length = rest
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(rest.len());
        if length == 0 {
            return Err(self.damaged(expected, "the end of the file"));
        }
        let word = std::str::from_utf8(&rest[..length])
            .map_err(|_| self.damaged(expected, "bytes that are no text"))?;
        self.pos += length;
        Ok(word)
    }

    /// The rest of the current line, without its end.
    pub(crate) fn line(&mut self, expected: &str) -> Result<&'a str, MeshError> {
        let rest = &self.data[self.pos..];
        if rest.is_empty() {
            return Err(self.damaged(expected, "the end of the file"));
        }
        let length = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        let text = std::str::from_utf8(&rest[..length])
            .map_err(|_| self.damaged(expected, "bytes that are no text"))?;
        self.pos += (length + 1).min(rest.len());
        Ok(text.trim())
    }

    /// Name of the next `$Section`, its header line consumed; `None` at the end of the file.
    pub(crate) fn section(&mut self) -> Result<Option<&'a str>, MeshError> {
        self.skip_white();
        if self.remaining() == 0 {
            return Ok(None);
        }
        let expected = "a section such as $Nodes";
        if self.data[self.pos] != b'$' {
            let word = self.word(expected)?.to_string();
            return Err(self.damaged(expected, shown(&word)));
        }
        let name = &self.line(expected)?[1..];
        if name.is_empty() || name.starts_with("End") {
            return Err(self.damaged(expected, shown(&format!("${name}"))));
        }
        Ok(Some(name))
    }

    /// Reads `$End<name>`.
    pub(crate) fn end(&mut self, name: &str) -> Result<(), MeshError> {
        let expected = format!("$End{name}");
        let word = self.word(&expected)?;
        if word == expected {
            Ok(())
        } else {
            Err(self.damaged(&expected, shown(word)))
        }
    }

    /// Skips to behind `$End<name>`.
    pub(crate) fn skip_section(&mut self, name: &str) -> Result<(), MeshError> {
        let end = format!("$End{name}");
        let found = self.data[self.pos..]
            .windows(end.len())
            .position(|w| w == end.as_bytes());
        let Some(at) = found else {
            self.pos = self.data.len();
            return Err(self.damaged(&end, "the end of the file"));
        };
        self.pos += at + end.len();
        Ok(())
    }

    fn bytes<const N: usize>(&mut self, expected: &str) -> Result<[u8; N], MeshError> {
        let slice = self.data[self.pos..].first_chunk::<N>();
        let bytes = *slice.ok_or_else(|| self.damaged(expected, "the end of the file"))?;
        self.pos += N;
        Ok(bytes)
    }

    /// Reads the binary 1 that tells the byte order.
    pub(crate) fn read_byte_order(&mut self, size_bytes: usize) -> Result<(), MeshError> {
        self.encoding = Encoding::Binary {
            big_endian: false,
            size_bytes,
        };
        let big_endian = match self.bytes::<4>("the number 1 that tells the byte order")? {
            [1, 0, 0, 0] => false,
            [0, 0, 0, 1] => true,
            other => return Err(self.damaged("the number 1 that tells the byte order", format!("{other:?}"))),
        };
        self.encoding = Encoding::Binary {
            big_endian,
            size_bytes,
        };
        Ok(())
    }

    /// A signed integer (`int`).
    pub(crate) fn int(&mut self, expected: &str) -> Result<i64, MeshError> {
        match self.encoding {
            Encoding::Ascii => self.parse(expected),
            Encoding::Binary {
                big_endian: false, ..
            } => Ok(i32::from_le_bytes(self.bytes(expected)?).into()),
            Encoding::Binary { big_endian: true, .. } => Ok(i32::from_be_bytes(self.bytes(expected)?).into()),
        }
    }

    /// A count or a tag (`size_t`).
    pub(crate) fn size(&mut self, expected: &str) -> Result<u64, MeshError> {
        match self.encoding {
            Encoding::Ascii => self.parse(expected),
            Encoding::Binary {
                big_endian,
                size_bytes: 4,
            } => {
                let bytes = self.bytes(expected)?;
                Ok(if big_endian {
                    u32::from_be_bytes(bytes)
                } else {
                    u32::from_le_bytes(bytes)
                }
                .into())
            }
            Encoding::Binary { big_endian, .. } => {
                let bytes = self.bytes(expected)?;
                Ok(if big_endian {
                    u64::from_be_bytes(bytes)
                } else {
                    u64::from_le_bytes(bytes)
                })
            }
        }
    }

    /// A floating-point number (`double`); may be NaN or infinite.
    pub(crate) fn real(&mut self, expected: &str) -> Result<f64, MeshError> {
        match self.encoding {
            Encoding::Ascii => self.parse(expected),
            Encoding::Binary {
                big_endian: false, ..
            } => Ok(f64::from_le_bytes(self.bytes(expected)?)),
            Encoding::Binary { big_endian: true, .. } => Ok(f64::from_be_bytes(self.bytes(expected)?)),
        }
    }

    /// A word of text as a number.
    pub(crate) fn parse<T: std::str::FromStr>(&mut self, expected: &str) -> Result<T, MeshError> {
        let word = self.word(expected)?;
        word.parse().map_err(|_| self.damaged(expected, shown(word)))
    }

    /// A count of things, each of which takes at least `ints`, `sizes` and `reals` of the file: refused when
    /// the rest of the file cannot hold them, so that no damaged count can exhaust the memory.
    pub(crate) fn count(
        &mut self,
        what: &'static str,
        [ints, sizes, reals]: [usize; 3],
    ) -> Result<usize, MeshError> {
        let announced = self.size(what)?;
        let each = match self.encoding {
            // A digit and a separator; the last separator may be missing.
            Encoding::Ascii => 2 * (ints + sizes + reals),
            Encoding::Binary { size_bytes, .. } => 4 * ints + size_bytes * sizes + 8 * reals,
        };
        let possible = (self.remaining() + 1) / each.max(1);
        if announced > possible as u64 {
            return Err(self.mismatch(
                what,
                announced,
                format!("at most {possible} in the rest of the file"),
            ));
        }
        Ok(announced as usize)
    }
}

/// A word for a message: quoted, printable and short.
pub(crate) fn shown(word: &str) -> String {
    let short: String = word.chars().take(40).collect();
    format!("{short:?}")
}
