//! One source file as plain data: its lines of code, what it declares, and what it names.
//!
//! *Code* is what is left without comments, documentation, and items that exist for tests alone.

use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};

use anyhow::Context;
use proc_macro2::{LineColumn, Span, TokenStream, TokenTree};
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Attribute, ImplItem, Item, UseTree, Visibility};

use crate::code::{code_lines, is_test, whole_text};

/// A Rust file.
pub struct Source {
    /// Path from the root of the repository.
    pub path: PathBuf,
    /// Every line with nothing but its code; comments and tests are blank.
    pub code: Vec<String>,
    /// What stands in the file outside inline modules.
    pub contents: Contents,
    /// All functions with a body.
    pub functions: Vec<Named>,
    /// All structs, enums, unions, traits and aliases.
    pub types: Vec<Named>,
}

/// Something with a name, and the lines it stands on.
pub struct Named {
    /// Its name.
    pub name: String,
    /// First and last line, from 1.
    pub lines: RangeInclusive<usize>,
}

/// What one module declares and names.
#[derive(Default)]
pub struct Contents {
    /// Names of its items, without modules and imports.
    pub items: Vec<String>,
    /// Its modules.
    pub modules: Vec<Child>,
    /// Its imports, also those inside functions.
    pub imports: Vec<Import>,
    /// All paths in its code.
    pub paths: Vec<PathAt>,
}

/// A module in a module.
pub struct Child {
    /// Its name.
    pub name: String,
    /// Where its contents are.
    pub body: Body,
}

/// Where the contents of a module are.
pub enum Body {
    /// In the same file.
    Inline(Contents),
    /// In a file, at the place that `#[path]` gives or at the usual one.
    File(Option<PathBuf>),
}

/// One name that a `use` brings.
pub struct Import {
    /// What it names; for `a::*`, the path before the star.
    pub path: PathAt,
    /// The name it has here; none for a star.
    pub name: Option<String>,
    /// Whether others see it.
    pub public: bool,
}

/// A path such as `crate::a::B`, segment by segment.
#[derive(Clone)]
pub struct PathAt {
    /// Segments, keywords too; a leading `::` is an empty segment.
    pub segments: Vec<String>,
    /// Line, from 1.
    pub line: usize,
}

impl Source {
    /// Reads the file `path` below `root`.
    pub fn read(root: &Path, path: &Path) -> anyhow::Result<Source> {
        let text = std::fs::read_to_string(root.join(path)).with_context(|| path.display().to_string())?;
        Source::parse(path, &text).with_context(|| format!("{} is no Rust that syn reads", path.display()))
    }

    fn parse(path: &Path, text: &str) -> anyhow::Result<Source> {
        let file = syn::parse_file(text)?;
        let mut reader = Reader {
            contents: Contents::default(),
            functions: Vec::new(),
            types: Vec::new(),
            tests: Vec::new(),
        };
        if file.attrs.iter().any(is_test) {
            reader.tests.push(whole_text());
        } else {
            reader.visit_file(&file);
        }
        Ok(Source {
            path: path.to_path_buf(),
            code: code_lines(text, &reader.tests)?,
            contents: reader.contents,
            functions: reader.functions,
            types: reader.types,
        })
    }

    /// Number of lines.
    pub fn n_lines(&self) -> usize {
        self.code.len()
    }

    /// Number of lines with code.
    pub fn n_code_lines(&self) -> usize {
        self.code.iter().filter(|line| !line.trim().is_empty()).count()
    }
}

/// Collects a file, skipping tests.
struct Reader {
    contents: Contents,
    functions: Vec<Named>,
    types: Vec<Named>,
    /// From where to where items of tests stand.
    tests: Vec<Range<LineColumn>>,
}

impl Reader {
    /// Notes an item that is for tests alone.
    fn skips(&mut self, attributes: &[Attribute], span: Span) -> bool {
        if !attributes.iter().any(is_test) {
            return false;
        }
        let first = attributes.iter().map(|attribute| attribute.span().start()).min();
        let start = first.map_or(span.start(), |first| first.min(span.start()));
        self.tests.push(start..span.end());
        true
    }

    fn note_function(&mut self, signature: &syn::Signature, block: &syn::Block) {
        let first = signature.fn_token.span.start().line;
        let last = block.brace_token.span.close().end().line;
        self.functions.push(Named {
            name: signature.ident.to_string(),
            lines: first..=last,
        });
    }

    fn note_type(&mut self, ident: &syn::Ident) {
        let line = ident.span().start().line;
        self.types.push(Named {
            name: ident.to_string(),
            lines: line..=line,
        });
    }

    fn note_path(&mut self, segments: Vec<String>, line: usize) {
        self.contents.paths.push(PathAt { segments, line });
    }

    /// Paths among the tokens of a macro or an attribute, which have no syntax of their own.
    fn note_tokens(&mut self, stream: TokenStream) {
        let mut segments: Vec<String> = Vec::new();
        let mut line = 0;
        let mut colons = 0;
        let mut after_dot = false;
        for token in stream {
            match token {
                TokenTree::Ident(ident) => {
                    let continues = colons == 2 && !segments.is_empty();
                    if !continues {
                        self.end_of_tokens(&mut segments, line);
                        line = ident.span().start().line;
                    }
                    if continues || !after_dot {
                        segments.push(ident.to_string());
                    }
                    (colons, after_dot) = (0, false);
                }
                TokenTree::Punct(mark) if mark.as_char() == ':' => colons += 1,
                TokenTree::Punct(mark) => {
                    self.end_of_tokens(&mut segments, line);
                    (colons, after_dot) = (0, mark.as_char() == '.');
                }
                TokenTree::Group(group) => {
                    self.end_of_tokens(&mut segments, line);
                    (colons, after_dot) = (0, false);
                    self.note_tokens(group.stream());
                }
                TokenTree::Literal(_) => {
                    self.end_of_tokens(&mut segments, line);
                    (colons, after_dot) = (0, false);
                }
            }
        }
        self.end_of_tokens(&mut segments, line);
    }

    fn end_of_tokens(&mut self, segments: &mut Vec<String>, line: usize) {
        if !segments.is_empty() {
            self.note_path(std::mem::take(segments), line);
        }
    }

    fn note_imports(&mut self, tree: &UseTree, before: &[String], public: bool) {
        let import = |segments: Vec<String>, line: usize, name: Option<String>| Import {
            path: PathAt { segments, line },
            name,
            public,
        };
        let with = |ident: &syn::Ident| {
            let mut segments = before.to_vec();
            segments.push(ident.to_string());
            segments
        };
        match tree {
            UseTree::Path(path) => self.note_imports(&path.tree, &with(&path.ident), public),
            UseTree::Name(name) if name.ident == "self" => {
                let line = name.ident.span().start().line;
                let last = before.last().cloned();
                self.contents.imports.push(import(before.to_vec(), line, last));
            }
            UseTree::Name(name) => {
                let line = name.ident.span().start().line;
                let here = Some(name.ident.to_string());
                self.contents.imports.push(import(with(&name.ident), line, here));
            }
            UseTree::Rename(rename) => {
                let line = rename.ident.span().start().line;
                let segments = if rename.ident == "self" {
                    before.to_vec()
                } else {
                    with(&rename.ident)
                };
                let here = Some(rename.rename.to_string());
                self.contents.imports.push(import(segments, line, here));
            }
            UseTree::Glob(star) => {
                let line = star.star_token.span.start().line;
                self.contents.imports.push(import(before.to_vec(), line, None));
            }
            UseTree::Group(group) => {
                for tree in &group.items {
                    self.note_imports(tree, before, public);
                }
            }
        }
    }
}

impl<'a> Visit<'a> for Reader {
    fn visit_file(&mut self, file: &'a syn::File) {
        for item in &file.items {
            self.contents.items.extend(name_of(item));
        }
        visit::visit_file(self, file);
    }

    fn visit_item(&mut self, item: &'a Item) {
        if !self.skips(attributes_of(item), item.span()) {
            visit::visit_item(self, item);
        }
    }

    fn visit_impl_item(&mut self, item: &'a ImplItem) {
        let attributes = match item {
            ImplItem::Const(item) => &item.attrs,
            ImplItem::Fn(item) => &item.attrs,
            ImplItem::Type(item) => &item.attrs,
            ImplItem::Macro(item) => &item.attrs,
            _ => return,
        };
        if !self.skips(attributes, item.span()) {
            visit::visit_impl_item(self, item);
        }
    }

    fn visit_trait_item_fn(&mut self, item: &'a syn::TraitItemFn) {
        if self.skips(&item.attrs, item.span()) {
            return;
        }
        if let Some(block) = &item.default {
            self.note_function(&item.sig, block);
        }
        visit::visit_trait_item_fn(self, item);
    }

    fn visit_item_mod(&mut self, module: &'a syn::ItemMod) {
        let name = module.ident.to_string();
        let body = match &module.content {
            None => Body::File(path_attribute(&module.attrs)),
            Some((_, items)) => {
                let outer = std::mem::take(&mut self.contents);
                for item in items {
                    self.contents.items.extend(name_of(item));
                }
                for item in items {
                    self.visit_item(item);
                }
                Body::Inline(std::mem::replace(&mut self.contents, outer))
            }
        };
        self.contents.modules.push(Child { name, body });
    }

    fn visit_item_use(&mut self, item: &'a syn::ItemUse) {
        let before = if item.leading_colon.is_some() {
            vec![String::new()]
        } else {
            Vec::new()
        };
        let public = !matches!(item.vis, Visibility::Inherited);
        self.note_imports(&item.tree, &before, public);
    }

    fn visit_item_fn(&mut self, item: &'a syn::ItemFn) {
        self.note_function(&item.sig, &item.block);
        visit::visit_item_fn(self, item);
    }

    fn visit_impl_item_fn(&mut self, item: &'a syn::ImplItemFn) {
        self.note_function(&item.sig, &item.block);
        visit::visit_impl_item_fn(self, item);
    }

    fn visit_item_struct(&mut self, item: &'a syn::ItemStruct) {
        self.note_type(&item.ident);
        visit::visit_item_struct(self, item);
    }

    fn visit_item_enum(&mut self, item: &'a syn::ItemEnum) {
        self.note_type(&item.ident);
        visit::visit_item_enum(self, item);
    }

    fn visit_item_union(&mut self, item: &'a syn::ItemUnion) {
        self.note_type(&item.ident);
        visit::visit_item_union(self, item);
    }

    fn visit_item_trait(&mut self, item: &'a syn::ItemTrait) {
        self.note_type(&item.ident);
        visit::visit_item_trait(self, item);
    }

    fn visit_item_type(&mut self, item: &'a syn::ItemType) {
        self.note_type(&item.ident);
        visit::visit_item_type(self, item);
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        let mut segments: Vec<String> = path
            .segments
            .iter()
            .map(|segment| segment.ident.to_string())
            .collect();
        if path.leading_colon.is_some() {
            segments.insert(0, String::new());
        }
        self.note_path(segments, path.span().start().line);
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'a syn::Macro) {
        self.note_tokens(call.tokens.clone());
        visit::visit_macro(self, call);
    }

    fn visit_meta_list(&mut self, list: &'a syn::MetaList) {
        self.note_tokens(list.tokens.clone());
    }
}

fn path_attribute(attributes: &[Attribute]) -> Option<PathBuf> {
    attributes.iter().find_map(|attribute| match &attribute.meta {
        syn::Meta::NameValue(pair) if pair.path.is_ident("path") => match &pair.value {
            syn::Expr::Lit(literal) => match &literal.lit {
                syn::Lit::Str(text) => Some(PathBuf::from(text.value())),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    })
}

fn attributes_of(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::ExternCrate(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::ForeignMod(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::TraitAlias(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Union(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// The name that an item gives its module; modules and imports are noted elsewhere.
fn name_of(item: &Item) -> Option<String> {
    if attributes_of(item).iter().any(is_test) {
        return None;
    }
    let ident = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Macro(item) => item.ident.as_ref()?,
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::TraitAlias(item) => &item.ident,
        Item::Type(item) => &item.ident,
        Item::Union(item) => &item.ident,
        _ => return None,
    };
    Some(ident.to_string())
}
