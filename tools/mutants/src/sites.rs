//! The places of the code that can be changed, and how.

use crate::Result;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{BinOp, Expr, Lit, Stmt, UnOp};

/// One change of the code.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Site {
    /// Path from the crate's root.
    pub file: String,
    pub line: usize,
    /// What is replaced: bytes of the file.
    pub range: Range<usize>,
    pub operator: String,
    pub original: String,
    /// What replaces it; nothing if a statement is dropped.
    pub mutant: Option<String>,
}

impl Site {
    /// What tells it from all others, however many lines tests may add below it.
    pub fn key(&self) -> String {
        format!(
            "{}:{}:{}:{}",
            self.file,
            self.range.start,
            self.range.end,
            self.change()
        )
    }

    /// Original and mutant in one line.
    pub fn change(&self) -> String {
        let line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        match &self.mutant {
            Some(mutant) => format!("`{}` → `{}`", line(&self.original), line(mutant)),
            None => format!("`{}` → nothing", line(&self.original)),
        }
    }
}

impl fmt::Display for Site {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(
            f,
            "{}:{} {}: {}",
            self.file,
            self.line,
            self.operator,
            self.change()
        )
    }
}

/// All that can be changed in the files of `from`, in the order of files and places.
pub fn find(
    root: &Path,
    from: &[String],
    except: &[String],
    features: &[&str],
) -> Result<Vec<Site>> {
    let mut files = Vec::new();
    for start in from {
        collect(&root.join(start), &mut files)?;
    }
    files.sort();
    let mut tests = Vec::new();
    let mut found = Vec::new();
    for file in &files {
        let name = file
            .strip_prefix(root)
            .unwrap_or(file)
            .to_string_lossy()
            .into_owned();
        let text = std::fs::read_to_string(file).map_err(|error| format!("{name}: {error}"))?;
        let parsed = syn::parse_file(&text).map_err(|error| format!("{name}: {error}"))?;
        let mut visitor = Visitor {
            file: name,
            text: &text,
            features,
            folder: file.parent().unwrap_or(root),
            sites: Vec::new(),
            left_out: &mut tests,
        };
        visitor.visit_file(&parsed);
        found.extend(visitor.sites);
    }
    let tests: Vec<String> = tests
        .iter()
        .map(|file| {
            file.strip_prefix(root)
                .unwrap_or(file)
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    let excepted = |file: &str| tests.iter().chain(except).any(|name| is_at(file, name));
    found.retain(|site| !excepted(&site.file));
    Ok(found)
}

/// Whether a file is the one of this name, or in the folder of this name.
fn is_at(file: &str, name: &str) -> bool {
    let rest = file.strip_prefix(name);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
}

/// The Rust files at and under a path.
fn collect(path: &Path, files: &mut Vec<PathBuf>) -> Result<()> {
    if path.is_dir() {
        let entries =
            std::fs::read_dir(path).map_err(|error| format!("{}: {error}", path.display()))?;
        for entry in entries {
            let entry = entry.map_err(|error| error.to_string())?;
            collect(&entry.path(), files)?;
        }
    } else if path.extension().is_some_and(|extension| extension == "rs") {
        files.push(path.to_path_buf());
    }
    Ok(())
}

struct Visitor<'a> {
    file: String,
    text: &'a str,
    features: &'a [&'a str],
    folder: &'a Path,
    sites: Vec<Site>,
    /// Files and folders that are modules of tests, or of features that are off.
    left_out: &'a mut Vec<PathBuf>,
}

/// Traits whose implementations are texts or formats.
const FORMATS: [&str; 5] = ["Debug", "Display", "Error", "Serialize", "Deserialize"];
/// Methods that are exchanged, either way.
const METHODS: [(&str, &str); 6] = [
    ("max", "min"),
    ("sin", "cos"),
    ("any", "all"),
    ("first", "last"),
    ("is_some", "is_none"),
    ("floor", "ceil"),
];
/// Functions that are exchanged, either way.
const FUNCTIONS: [(&str, &str); 1] = [("rotate", "rotate_back")];
/// Methods without arguments that are left out.
const DROPPED: [&str; 6] = [
    "abs",
    "sqrt",
    "inverse",
    "transpose",
    "conjugate",
    "normalize",
];

/// The other one of a pair.
fn other(pairs: &[(&'static str, &'static str)], name: &str) -> Option<&'static str> {
    pairs.iter().find_map(|(a, b)| match name {
        _ if name == *a => Some(*b),
        _ if name == *b => Some(*a),
        _ => None,
    })
}

impl Visitor<'_> {
    fn text_of(&self, node: &impl Spanned) -> &str {
        &self.text[node.span().byte_range()]
    }

    fn add(&mut self, node: &impl Spanned, operator: &str, mutant: Option<String>) {
        let span = node.span();
        let range = span.byte_range();
        self.sites.push(Site {
            file: self.file.clone(),
            line: span.start().line,
            original: self.text[range.clone()].to_owned(),
            range,
            operator: operator.to_owned(),
            mutant,
        });
    }

    /// `node` with the text of `part` replaced.
    fn with(&self, node: &impl Spanned, part: &impl Spanned, by: &str) -> String {
        let (whole, part) = (node.span().byte_range(), part.span().byte_range());
        format!(
            "{}{by}{}",
            &self.text[whole.start..part.start],
            &self.text[part.end..whole.end]
        )
    }

    /// Whether code with these attributes is compiled, and not as a test.
    fn compiled(&self, attributes: &[syn::Attribute]) -> bool {
        attributes.iter().all(|attribute| {
            if attribute.path().is_ident("test") {
                return false;
            }
            if !attribute.path().is_ident("cfg") {
                return true;
            }
            let condition = self.text_of(attribute);
            let named = |feature: &&str| condition.contains(&format!("\"{feature}\""));
            let is = !condition.contains("(test")
                && (!condition.contains("feature") || self.features.iter().any(named));
            is != condition.contains("not(")
        })
    }

    fn binary(&mut self, node: &syn::ExprBinary) {
        let (operator, by) = match node.op {
            BinOp::Add(_) => ("arithmetic", "-"),
            BinOp::Sub(_) => ("arithmetic", "+"),
            BinOp::Mul(_) => ("arithmetic", "/"),
            BinOp::Div(_) => ("arithmetic", "*"),
            BinOp::AddAssign(_) => ("arithmetic", "-="),
            BinOp::SubAssign(_) => ("arithmetic", "+="),
            BinOp::MulAssign(_) => ("arithmetic", "/="),
            BinOp::DivAssign(_) => ("arithmetic", "*="),
            BinOp::Lt(_) => ("comparison", ">="),
            BinOp::Ge(_) => ("comparison", "<"),
            BinOp::Gt(_) => ("comparison", "<="),
            BinOp::Le(_) => ("comparison", ">"),
            BinOp::Eq(_) => ("comparison", "!="),
            BinOp::Ne(_) => ("comparison", "=="),
            BinOp::And(_) => ("logic", "||"),
            BinOp::Or(_) => ("logic", "&&"),
            _ => return,
        };
        // `a && let …` is no expression.
        if contains_let(&node.left) || contains_let(&node.right) {
            return;
        }
        let mutant = self.with(node, &node.op, by);
        self.add(node, operator, Some(mutant));
    }

    fn literal(&mut self, node: &syn::ExprLit) {
        let mutant = match &node.lit {
            Lit::Float(float) => {
                let Ok(value) = float.base10_parse::<f64>() else {
                    return;
                };
                let value = if value == 0.0 { 1.0 } else { value * 1.1 };
                format!("{value:?}{}", float.suffix())
            }
            Lit::Int(int) => {
                let Ok(value) = int.base10_parse::<u128>() else {
                    return;
                };
                let value = if value == 1 { 0 } else { value + 1 };
                format!("{value}{}", int.suffix())
            }
            Lit::Bool(bool) => {
                self.add(node, "logic", Some((!bool.value).to_string()));
                return;
            }
            _ => return,
        };
        self.add(node, "number", Some(mutant));
    }

    fn swapped(&mut self, node: &impl Spanned, arguments: &[&Expr]) {
        for pair in arguments.windows(2) {
            let (a, b) = (
                self.text_of(pair[0]).to_owned(),
                self.text_of(pair[1]).to_owned(),
            );
            if a == b {
                continue;
            }
            let whole = node.span().byte_range();
            let (first, second) = (pair[0].span().byte_range(), pair[1].span().byte_range());
            let mutant = format!(
                "{}{b}{}{a}{}",
                &self.text[whole.start..first.start],
                &self.text[first.end..second.start],
                &self.text[second.end..whole.end]
            );
            self.add(node, "arguments swapped", Some(mutant));
        }
    }

    fn negated(&mut self, value: &Expr) {
        if matches!(
            value,
            Expr::Binary(_)
                | Expr::Call(_)
                | Expr::MethodCall(_)
                | Expr::Path(_)
                | Expr::Field(_)
                | Expr::Paren(_)
        ) {
            let mutant = format!("-({})", self.text_of(value));
            self.add(value, "minus added", Some(mutant));
        }
    }

    fn condition(&mut self, condition: &Expr) {
        if matches!(
            condition,
            Expr::Call(_) | Expr::MethodCall(_) | Expr::Path(_) | Expr::Field(_)
        ) {
            let mutant = format!("!({})", self.text_of(condition));
            self.add(condition, "logic", Some(mutant));
        }
    }
}

/// Whether an operand is, or begins with, a `let` of a chain.
fn contains_let(node: &Expr) -> bool {
    match node {
        Expr::Let(_) => true,
        Expr::Binary(node) if matches!(node.op, BinOp::And(_)) => {
            contains_let(&node.left) || contains_let(&node.right)
        }
        _ => false,
    }
}

impl<'ast> Visit<'ast> for Visitor<'_> {
    // What is evaluated by the compiler, or is no expression.
    fn visit_item_const(&mut self, _: &'ast syn::ItemConst) {}
    fn visit_item_static(&mut self, _: &'ast syn::ItemStatic) {}
    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}
    fn visit_trait_item_const(&mut self, _: &'ast syn::TraitItemConst) {}
    fn visit_expr_const(&mut self, _: &'ast syn::ExprConst) {}
    fn visit_item_enum(&mut self, _: &'ast syn::ItemEnum) {}
    fn visit_pat(&mut self, _: &'ast syn::Pat) {}
    fn visit_type(&mut self, _: &'ast syn::Type) {}
    fn visit_generic_argument(&mut self, _: &'ast syn::GenericArgument) {}
    fn visit_generics(&mut self, _: &'ast syn::Generics) {}
    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}
    fn visit_macro(&mut self, _: &'ast syn::Macro) {}
    fn visit_expr_repeat(&mut self, node: &'ast syn::ExprRepeat) {
        self.visit_expr(&node.expr);
    }

    fn visit_item_mod(&mut self, node: &'ast syn::ItemMod) {
        if self.compiled(&node.attrs) {
            visit::visit_item_mod(self, node);
        } else if node.content.is_none() {
            let name = node.ident.to_string();
            self.left_out.push(self.folder.join(format!("{name}.rs")));
            self.left_out.push(self.folder.join(name));
        }
    }

    fn visit_item_fn(&mut self, node: &'ast syn::ItemFn) {
        if self.compiled(&node.attrs) && node.sig.constness.is_none() {
            visit::visit_item_fn(self, node);
        }
    }

    fn visit_impl_item_fn(&mut self, node: &'ast syn::ImplItemFn) {
        if self.compiled(&node.attrs) && node.sig.constness.is_none() {
            visit::visit_impl_item_fn(self, node);
        }
    }

    fn visit_item_impl(&mut self, node: &'ast syn::ItemImpl) {
        let formats = node.trait_.as_ref().is_some_and(|(_, path, _)| {
            path.segments
                .last()
                .is_some_and(|last| FORMATS.iter().any(|name| last.ident == name))
        });
        if !formats && self.compiled(&node.attrs) {
            visit::visit_item_impl(self, node);
        }
    }

    fn visit_stmt(&mut self, node: &'ast Stmt) {
        match node {
            Stmt::Local(local) => {
                if !self.compiled(&local.attrs) {
                    return;
                }
                if let Some(init) = &local.init {
                    self.negated(&init.expr);
                }
            }
            Stmt::Expr(expression, semicolon) => {
                let attributes: &[syn::Attribute] = match expression {
                    Expr::Block(block) => &block.attrs,
                    Expr::If(branch) => &branch.attrs,
                    Expr::MethodCall(call) => &call.attrs,
                    _ => &[],
                };
                if !self.compiled(attributes) {
                    return;
                }
                let assigns = |op: &BinOp| {
                    matches!(
                        op,
                        BinOp::AddAssign(_)
                            | BinOp::SubAssign(_)
                            | BinOp::MulAssign(_)
                            | BinOp::DivAssign(_)
                    )
                };
                let dropped = match expression {
                    Expr::Assign(_) | Expr::MethodCall(_) | Expr::Call(_) | Expr::Try(_) => true,
                    Expr::Binary(node) => assigns(&node.op),
                    _ => false,
                };
                if dropped && semicolon.is_some() {
                    self.add(node, "statement dropped", None);
                }
            }
            Stmt::Item(_) | Stmt::Macro(_) => {}
        }
        visit::visit_stmt(self, node);
    }

    fn visit_field_value(&mut self, node: &'ast syn::FieldValue) {
        if node.colon_token.is_some() {
            self.negated(&node.expr);
            visit::visit_field_value(self, node);
        }
    }

    fn visit_expr(&mut self, node: &'ast Expr) {
        match node {
            Expr::Binary(node) => self.binary(node),
            Expr::Lit(node) => self.literal(node),
            Expr::Unary(unary) => {
                let (operator, is) = match unary.op {
                    UnOp::Neg(_) => ("minus dropped", true),
                    UnOp::Not(_) => ("logic", true),
                    _ => ("", false),
                };
                if is {
                    let mutant = self.text_of(&unary.expr).to_owned();
                    self.add(node, operator, Some(mutant));
                }
            }
            Expr::Assign(assignment) => self.negated(&assignment.right),
            Expr::If(branch) => self.condition(&branch.cond),
            Expr::While(branch) => self.condition(&branch.cond),
            Expr::Call(call) => {
                let arguments: Vec<&Expr> = call.args.iter().collect();
                self.swapped(node, &arguments);
                if let Expr::Path(path) = &*call.func
                    && let Some(last) = path.path.segments.last()
                    && let Some(name) = other(&FUNCTIONS, &last.ident.to_string())
                {
                    let mutant = self.with(node, &last.ident, name);
                    self.add(node, "call", Some(mutant));
                }
            }
            Expr::MethodCall(call) => {
                let arguments: Vec<&Expr> = call.args.iter().collect();
                self.swapped(node, &arguments);
                let name = call.method.to_string();
                if let Some(name) = other(&METHODS, &name) {
                    let mutant = self.with(node, &call.method, name);
                    self.add(node, "call", Some(mutant));
                }
                if call.args.is_empty() && DROPPED.contains(&name.as_str()) {
                    let mutant = self.text_of(&call.receiver).to_owned();
                    self.add(node, "call dropped", Some(mutant));
                }
            }
            _ => {}
        }
        visit::visit_expr(self, node);
    }
}
