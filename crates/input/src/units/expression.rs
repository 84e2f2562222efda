//! Unit expressions: `N s/mm`, `kg/m3`, `N/mm^1.5`, `1/(m s)`.

use super::error::UnitError;

use super::symbol;
use super::unit::{Dimension, Unit};

/// Deepest nesting of parentheses: more is a mistake, and unbounded recursion would overflow the stack.
const MAX_DEPTH: usize = 8;

/// What is wrong with an expression.
#[derive(Debug)]
pub enum ExpressionError {
    /// A symbol that is not in the tables.
    Unknown(String),
    /// Anything else, as a clause.
    Malformed(String),
}

impl ExpressionError {
    /// Adds the whole text and what was expected; `unit` is its unit with the dimension that it should have, if one is
    /// known.
    pub fn into_error(self, text: &str, expected: &str, unit: (&str, Option<Dimension>)) -> UnitError {
        let (text, expected) = (text.to_string(), expected.to_string());
        match self {
            ExpressionError::Malformed(reason) => UnitError::Malformed {
                text,
                reason,
                expected,
            },
            ExpressionError::Unknown(symbol) => {
                // A factor of a unit may have any dimension.
                let wanted = unit.1.filter(|_| unit.0 == symbol);
                let suggestion = symbol::suggest(&symbol, wanted)
                    .map_or(String::new(), |s| format!(" (did you mean \"{s}\"?)"));
                UnitError::UnknownUnit {
                    text,
                    symbol,
                    suggestion,
                    expected,
                }
            }
        }
    }
}

/// Reads a whole expression.
pub fn parse(text: &str) -> Result<Unit, ExpressionError> {
    let chars: Vec<char> = text.chars().collect();
    let mut parser = Parser {
        chars: &chars,
        at: 0,
        depth: 0,
    };
    let unit = parser.expression()?;
    match parser.peek() {
        None => Ok(unit),
        Some(c) => Err(malformed(format!("unexpected '{c}'"))),
    }
}

fn malformed(reason: impl Into<String>) -> ExpressionError {
    ExpressionError::Malformed(reason.into())
}

/// A cursor over the characters of an expression.
struct Parser<'a> {
    chars: &'a [char],
    at: usize,
    depth: usize,
}

impl Parser<'_> {
    fn peek(&self) -> Option<char> {
        self.chars.get(self.at).copied()
    }

    fn skip_spaces(&mut self) {
        while self.peek().is_some_and(char::is_whitespace) {
            self.at += 1;
        }
    }

    /// factor { product-or-quotient factor }, left to right, up to the end or a closing parenthesis.
    fn expression(&mut self) -> Result<Unit, ExpressionError> {
        let mut unit = Unit::ONE;
        let mut divided = false;
        self.skip_spaces();
        if self.peek() != Some('/') {
            unit = self.factor()?;
        }
        loop {
            self.skip_spaces();
            match self.peek() {
                None | Some(')') => return Ok(unit),
                Some('/') => {
                    self.at += 1;
                    unit = unit.times(self.factor()?.raised(-1.0));
                    divided = true;
                }
                Some(_) if divided => {
                    let hint = "a product after '/' is ambiguous, write \"kg/(m s)\" or \"kg s/m\"";
                    return Err(malformed(hint));
                }
                Some('*' | '.' | '·') => {
                    self.at += 1;
                    unit = unit.times(self.factor()?);
                }
                Some(_) => unit = unit.times(self.factor()?),
            }
        }
    }

    /// A symbol, the number 1 or a parenthesis, with an optional power.
    fn factor(&mut self) -> Result<Unit, ExpressionError> {
        self.skip_spaces();
        let start = self.at;
        let base = match self.peek() {
            None => return Err(malformed("it ends where a unit is needed")),
            Some('(') => self.parenthesis()?,
            Some('1') => {
                self.at += 1;
                return Ok(Unit::ONE);
            }
            Some(c) if is_symbol_char(c) => self.symbol()?,
            Some(c) => return Err(malformed(format!("unexpected '{c}'"))),
        };
        Ok(match self.power(start)? {
            Some(power) => base.raised(power),
            None => base,
        })
    }

    fn parenthesis(&mut self) -> Result<Unit, ExpressionError> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(malformed("too many nested parentheses"));
        }
        self.at += 1;
        let unit = self.expression()?;
        if self.peek() != Some(')') {
            return Err(malformed("a parenthesis is not closed"));
        }
        self.at += 1;
        self.depth -= 1;
        Ok(unit)
    }

    fn symbol(&mut self) -> Result<Unit, ExpressionError> {
        let start = self.at;
        while self.peek().is_some_and(is_symbol_char) {
            self.at += 1;
        }
        let name: String = self.chars[start..self.at].iter().collect();
        symbol::find(&name).ok_or(ExpressionError::Unknown(name))
    }

    /// `^1.5`, `^(10/9)`, `3`, `-2`, `³`, `⁻²`; `None` when no power follows. What is raised begins at `start`.
    fn power(&mut self, start: usize) -> Result<Option<f64>, ExpressionError> {
        match self.peek() {
            Some('^') => {
                self.at += 1;
                self.caret_power().map(Some)
            }
            Some(c) if c == '-' || c.is_ascii_digit() => {
                let (base, power) = (self.at, self.take_number(|c| c.is_ascii_digit())?);
                self.require_whole_power(start, base)?;
                Ok(Some(power))
            }
            Some(c) if superscript(c).is_some() => {
                let mut digits = String::new();
                while let Some(c) = self.peek().and_then(superscript) {
                    digits.push(c);
                    self.at += 1;
                }
                parse_power(&digits).map(Some)
            }
            _ => Ok(None),
        }
    }

    /// Fails where a power that follows without `^`, from `base` on, goes on behind a decimal point.
    fn require_whole_power(&self, start: usize, base: usize) -> Result<(), ExpressionError> {
        let digits = self.chars[self.at..].iter().skip(1);
        let n = digits.take_while(|c| c.is_ascii_digit()).count();
        if self.peek() != Some('.') || n == 0 {
            return Ok(());
        }
        let text = |from: usize, to: usize| self.chars[from..to].iter().collect::<String>();
        let power = text(base, self.at + 1 + n);
        Err(malformed(format!(
            "a power with a decimal point needs '^', write \"{}^{power}\"",
            text(start, base)
        )))
    }

    fn caret_power(&mut self) -> Result<f64, ExpressionError> {
        let decimal = |c: char| c.is_ascii_digit() || c == '.';
        if self.peek() != Some('(') {
            return self.take_number(decimal);
        }
        self.at += 1;
        let mut power = self.take_number(decimal)?;
        if self.peek() == Some('/') {
            self.at += 1;
            power /= self.take_number(decimal)?;
        }
        if self.peek() != Some(')') {
            return Err(malformed("the parenthesis of a power is not closed"));
        }
        self.at += 1;
        Ok(power)
    }

    fn take_number(&mut self, accepts: impl Fn(char) -> bool) -> Result<f64, ExpressionError> {
        let start = self.at;
        if matches!(self.peek(), Some('-' | '+')) {
            self.at += 1;
        }
        while self.peek().is_some_and(&accepts) {
            self.at += 1;
        }
        // In "m^2.s" the point is a product.
        if self.at > start && self.chars[self.at - 1] == '.' {
            self.at -= 1;
        }
        parse_power(&self.chars[start..self.at].iter().collect::<String>())
    }
}

/// Powers beyond this have no meaning and could overflow the power of ten.
const MAX_POWER: f64 = 12.0;

fn parse_power(text: &str) -> Result<f64, ExpressionError> {
    let power: f64 = text
        .parse()
        .map_err(|_| malformed(format!("\"{text}\" is not a power")))?;
    if power == 0.0 || power.abs() > MAX_POWER {
        return Err(malformed(format!(
            "the power {text} is zero or larger than {MAX_POWER}"
        )));
    }
    Ok(power)
}

fn is_symbol_char(c: char) -> bool {
    (c.is_alphabetic() || c == '°' || c == '%') && superscript(c).is_none()
}

fn superscript(c: char) -> Option<char> {
    const SUPERSCRIPTS: [char; 11] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹', '⁻'];
    const PLAIN: [char; 11] = ['0', '1', '2', '3', '4', '5', '6', '7', '8', '9', '-'];
    SUPERSCRIPTS.iter().position(|&s| s == c).map(|i| PLAIN[i])
}
