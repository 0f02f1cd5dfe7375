//! Tables of SQLite 3 files, read from the pages themselves: what a GeoPackage needs, and no more.
//!
//! A file is pages of one size. A table is a tree of pages whose leaves hold its rows in the order of their numbers; a
//! row that is too long for its page goes on in a chain of pages. The table `sqlite_schema`, whose root is page 1, names
//! the others. Indexes, free pages and the log (`-wal`) are not read.
//!
//! Each page is taken once, whatever it is for: a file whose pages refer to one another in circles ends, and none takes
//! longer than its length.

use super::FormatError;
use super::text::SourceFile;
use indexmap::IndexMap;
use std::borrow::Cow;

/// What every file begins with.
pub(super) const MAGIC: &[u8] = b"SQLite format 3\0";
/// Bytes of the header, which page 1 begins with.
const HEADER: usize = 100;
/// Most columns that SQLite can be built for.
const MOST_COLUMNS: usize = 32_767;

/// A value of a row.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Cell<'r> {
    Null,
    Integer(i64),
    Real(f64),
    Text(Cow<'r, str>),
    Blob(&'r [u8]),
}

impl Cell<'_> {
    pub(super) fn text(&self) -> Option<&str> {
        if let Self::Text(text) = self { Some(text) } else { None }
    }

    pub(super) fn integer(&self) -> Option<i64> {
        if let Self::Integer(value) = self { Some(*value) } else { None }
    }
}

/// The values of a row, in the order of the columns.
pub(super) struct Row<'r> {
    cells: Vec<Cell<'r>>,
}

impl<'r> Row<'r> {
    /// The value of a column; rows that are older than their last columns lack these.
    pub(super) fn at(&self, column: Option<usize>) -> &Cell<'r> {
        column.and_then(|column| self.cells.get(column)).unwrap_or(&Cell::Null)
    }
}

/// A table: its columns, and where its rows are.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Table {
    pub columns: Vec<String>,
    /// The column that is the number of the row, which rows do not repeat.
    pub key: Option<usize>,
    root: usize,
}

impl Table {
    /// The column of a name, in any case, as in SQL.
    pub(super) fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.eq_ignore_ascii_case(name))
    }
}

#[derive(Debug, Clone, Copy)]
enum Encoding {
    Utf8,
    Utf16Little,
    Utf16Big,
}

/// A file of tables.
pub(super) struct Database<'a> {
    source: &'a SourceFile,
    page_size: usize,
    /// Bytes of a page without those that extensions reserve at its end.
    usable: usize,
    encoding: Encoding,
    /// Whether a page has been taken, by its number less 1.
    taken: Vec<bool>,
    /// Root and `CREATE` of each table, by its name in lower case; views have the root 0.
    schema: IndexMap<String, (usize, String)>,
}

impl<'a> Database<'a> {
    pub(super) fn open(source: &'a SourceFile) -> Result<Self, FormatError> {
        let bytes = source.bytes.as_slice();
        if !bytes.starts_with(MAGIC) {
            return Err(source.damaged("it does not begin as a database of SQLite 3: it is another file, or encrypted"));
        }
        let header = bytes.get(..HEADER).ok_or_else(|| source.length("bytes of its header", HEADER, bytes.len()))?;
        let page_size = match big(header, 16, 2) {
            Some(1) => 65_536,
            Some(size) if size >= 512 && size.is_power_of_two() => size,
            other => return Err(source.damaged(format!("pages of {} bytes", other.unwrap_or(0)))),
        };
        let usable = page_size - usize::from(header[20]);
        if usable < 480 {
            return Err(source.damaged(format!("pages of {page_size} bytes, of which {usable} can be used")));
        }
        let encoding = match big(header, 56, 4) {
            Some(2) => Encoding::Utf16Little,
            Some(3) => Encoding::Utf16Big,
            _ => Encoding::Utf8,
        };
        // Old versions do not keep the count of pages, and then the two counters of changes differ.
        let pages = bytes.len() / page_size;
        let stated = big(header, 28, 4).filter(|_| header[24..28] == header[92..96]).unwrap_or(0);
        if stated > pages {
            return Err(source.length("pages", stated, pages));
        }
        let mut made =
            Self { source, page_size, usable, encoding, taken: vec![false; pages], schema: IndexMap::default() };
        let columns = ["type", "name", "tbl_name", "rootpage", "sql"].map(str::to_owned).to_vec();
        let mut schema = IndexMap::new();
        made.rows(&Table { columns, key: None, root: 1 }, &mut |row| {
            if let (Some("table" | "view"), Some(name)) = (row.at(Some(0)).text(), row.at(Some(1)).text()) {
                let root = row.at(Some(3)).integer().and_then(|root| usize::try_from(root).ok()).unwrap_or(0);
                let sql = row.at(Some(4)).text().unwrap_or_default();
                schema.insert(name.to_ascii_lowercase(), (root, sql.to_owned()));
            }
            Ok(())
        })?;
        made.schema = schema;
        Ok(made)
    }

    /// The table of a name, in any case; views and virtual tables are none.
    pub(super) fn table(&self, name: &str) -> Option<Table> {
        let (root, sql) = self.schema.get(&name.to_ascii_lowercase()).filter(|(root, _)| *root > 0)?;
        Some(Table { root: *root, ..columns_of(sql) })
    }

    /// Shows each row of a table, which can be read once.
    pub(super) fn rows(
        &mut self,
        table: &Table,
        each: &mut dyn FnMut(&Row<'_>) -> Result<(), FormatError>,
    ) -> Result<(), FormatError> {
        let source = self.source;
        let mut pages = vec![self.take(table.root)?];
        while let Some((number, page)) = pages.pop() {
            let start = if number == 1 { HEADER } else { 0 };
            let cut = || source.damaged(format!("page {number} of its tables is cut short"));
            let count = big(page, start + 3, 2).ok_or_else(cut)?;
            match page.get(start) {
                Some(5) => {
                    let cell = |n: usize| big(page, big(page, start + 12 + 2 * n, 2)?, 4);
                    let children: Option<Vec<usize>> = (0..count).map(cell).chain([big(page, start + 8, 4)]).collect();
                    // The last one that is put there is the first one that is read.
                    for child in children.ok_or_else(cut)?.into_iter().rev() {
                        pages.push(self.take(child)?);
                    }
                }
                Some(13) => {
                    let mut used = 0;
                    for n in 0..count {
                        let leaf = big(page, start + 8 + 2 * n, 2).and_then(|at| self.leaf_cell(page.get(at..)?));
                        let leaf = leaf.ok_or_else(|| {
                            source.damaged(format!("row {n} of page {number} is longer than the page, or the file"))
                        })?;
                        used += leaf.inside.len() + 2;
                        if used > page.len() {
                            return Err(source.damaged(format!("the rows of page {number} overlap")));
                        }
                        let record = match leaf.beyond {
                            None => Cow::Borrowed(leaf.inside),
                            Some(first) => Cow::Owned(self.chained(leaf.inside, leaf.length, first)?),
                        };
                        let row = record_of(&record, leaf.number, table, self.encoding).ok_or_else(|| {
                            source.damaged(format!("row {n} of page {number} has columns beyond its end"))
                        })?;
                        each(&row)?;
                    }
                }
                other => {
                    let kind = other.copied().unwrap_or(0);
                    return Err(source.damaged(format!("page {number} is of kind {kind}, which no table has")));
                }
            }
        }
        Ok(())
    }

    /// A page that nothing has used before, and its number.
    fn take(&mut self, number: usize) -> Result<(usize, &'a [u8]), FormatError> {
        let Some(taken) = number.checked_sub(1).and_then(|n| self.taken.get_mut(n)) else {
            return Err(self.source.damaged(format!("page {number} is needed, and it has {} pages", self.taken.len())));
        };
        if std::mem::replace(taken, true) {
            return Err(self.source.damaged(format!("two of its pages lead to page {number}")));
        }
        let first = (number - 1) * self.page_size;
        Ok((number, self.source.bytes.get(first..first + self.usable).unwrap_or_default()))
    }

    /// A row of a leaf: how long it is, its number, what is in the page, and where it goes on.
    fn leaf_cell<'p>(&self, cell: &'p [u8]) -> Option<LeafCell<'p>> {
        let (length, rest) = varint(cell)?;
        let (number, rest) = varint(rest)?;
        let length = usize::try_from(length).ok().filter(|length| *length <= self.source.bytes.len())?;
        let most = self.usable - 35;
        if length <= most {
            return Some(LeafCell { length, number: number as i64, inside: rest.get(..length)?, beyond: None });
        }
        let least = (self.usable - 12) * 32 / 255 - 23;
        let filling = least + (length - least) % (self.usable - 4);
        let local = if filling <= most { filling } else { least };
        let (inside, rest) = rest.split_at_checked(local)?;
        Some(LeafCell { length, number: number as i64, inside, beyond: Some(big(rest, 0, 4)?) })
    }

    /// A row that goes on in other pages, each of which begins with the number of the next.
    fn chained(&mut self, start: &[u8], length: usize, first: usize) -> Result<Vec<u8>, FormatError> {
        let (mut all, mut next) = (start.to_vec(), first);
        while all.len() < length {
            let (_, page) = self.take(next)?;
            next = big(page, 0, 4).unwrap_or(0);
            let part = page.get(4..).unwrap_or_default();
            all.extend(&part[..part.len().min(length - all.len())]);
        }
        Ok(all)
    }
}

struct LeafCell<'p> {
    length: usize,
    number: i64,
    inside: &'p [u8],
    beyond: Option<usize>,
}

/// A number of 2 or 4 bytes, the highest first.
fn big(bytes: &[u8], at: usize, count: usize) -> Option<usize> {
    let bytes = bytes.get(at..at.checked_add(count)?)?;
    Some(bytes.iter().fold(0, |number, byte| number << 8 | usize::from(*byte)))
}

/// A number of 1 to 9 bytes, of which each but the ninth has 7 bits and tells whether there is another; and the rest.
fn varint(bytes: &[u8]) -> Option<(u64, &[u8])> {
    let mut number = 0_u64;
    for (n, byte) in bytes.iter().enumerate().take(9) {
        if n == 8 {
            return Some((number << 8 | u64::from(*byte), &bytes[9..]));
        }
        number = number << 7 | u64::from(byte & 0x7f);
        if *byte < 0x80 {
            return Some((number, &bytes[n + 1..]));
        }
    }
    None
}

/// The values of a record: a header of the kinds of its values, and then the values.
fn record_of<'r>(record: &'r [u8], number: i64, table: &Table, encoding: Encoding) -> Option<Row<'r>> {
    let (length, rest) = varint(record)?;
    let own = record.len() - rest.len();
    let length = usize::try_from(length).ok()?;
    let (mut kinds, mut body) = (record.get(own..length)?, &record[length..]);
    let mut cells = Vec::new();
    while !kinds.is_empty() && cells.len() < table.columns.len() {
        let (kind, rest) = varint(kinds)?;
        kinds = rest;
        let size = match kind {
            0 | 8 | 9 => 0,
            1..=4 => kind as usize,
            5 => 6,
            6 | 7 => 8,
            10 | 11 => return None,
            _ => usize::try_from((kind - 12) / 2).ok()?,
        };
        let (value, rest) = body.split_at_checked(size)?;
        body = rest;
        cells.push(match kind {
            0 => Cell::Null,
            7 => Cell::Real(f64::from_be_bytes(value.try_into().ok()?)),
            8 => Cell::Integer(0),
            9 => Cell::Integer(1),
            1..=6 => {
                // The first byte has the sign.
                let first = i64::from(value.first()?.cast_signed());
                Cell::Integer(value[1..].iter().fold(first, |number, byte| number << 8 | i64::from(*byte)))
            }
            _ if kind % 2 == 0 => Cell::Blob(value),
            _ => Cell::Text(text(value, encoding)),
        });
    }
    if let Some(cell) = table.key.and_then(|key| cells.get_mut(key)) {
        *cell = Cell::Integer(number);
    }
    Some(Row { cells })
}

fn text(bytes: &[u8], encoding: Encoding) -> Cow<'_, str> {
    let decoded = |of: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.as_chunks::<2>().0.iter().map(|unit| of(*unit)).collect();
        Cow::Owned(String::from_utf16_lossy(&units))
    };
    match encoding {
        Encoding::Utf8 => String::from_utf8_lossy(bytes),
        Encoding::Utf16Little => decoded(u16::from_le_bytes),
        Encoding::Utf16Big => decoded(u16::from_be_bytes),
    }
}

/// A part of an SQL text.
#[derive(Debug, Clone, PartialEq)]
enum Token {
    Word(String),
    /// A name in quotes, which is no word of the language.
    Quoted(String),
    Sign(char),
}

impl Token {
    fn is(&self, word: &str) -> bool {
        matches!(self, Self::Word(own) if own.eq_ignore_ascii_case(word))
    }

    fn name(&self) -> Option<&str> {
        match self {
            Self::Word(name) | Self::Quoted(name) => Some(name),
            Self::Sign(_) => None,
        }
    }
}

/// The words, names and signs of an SQL text, without comments.
fn tokens(sql: &str) -> Vec<Token> {
    let mut found = Vec::new();
    let mut rest = sql;
    while let Some(first) = rest.chars().next() {
        let after = &rest[first.len_utf8()..];
        let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '$') || !c.is_ascii();
        rest = if let Some(comment) = rest.strip_prefix("--") {
            comment.split_once('\n').map_or("", |(_, rest)| rest)
        } else if let Some(comment) = rest.strip_prefix("/*") {
            comment.split_once("*/").map_or("", |(_, rest)| rest)
        } else if matches!(first, '"' | '\'' | '`' | '[') {
            let (name, rest) = quoted(after, if first == '[' { ']' } else { first });
            found.push(Token::Quoted(name));
            rest
        } else if is_part(first) {
            let end = rest.find(|c| !is_part(c)).unwrap_or(rest.len());
            found.push(Token::Word(rest[..end].to_owned()));
            &rest[end..]
        } else {
            if !first.is_whitespace() {
                found.push(Token::Sign(first));
            }
            after
        };
    }
    found
}

/// A name up to the quote that ends it, and the rest; two quotes are one of the name.
fn quoted(text: &str, quote: char) -> (String, &str) {
    let (mut name, mut rest) = (String::new(), text);
    while let Some((part, after)) = rest.split_once(quote) {
        name.push_str(part);
        match after.strip_prefix(quote).filter(|_| quote != ']') {
            Some(more) => {
                name.push(quote);
                rest = more;
            }
            None => return (name, after),
        }
    }
    name.push_str(rest);
    (name, "")
}

/// The columns that a `CREATE TABLE` defines, without those that are computed when they are read.
fn columns_of(sql: &str) -> Table {
    let tokens = tokens(sql);
    let mut depth = 0_usize;
    let mut definitions: Vec<Vec<(usize, Token)>> = Vec::new();
    for token in tokens {
        match &token {
            Token::Sign('(') => depth += 1,
            Token::Sign(')') if depth <= 1 && !definitions.is_empty() => break,
            Token::Sign(')') => depth = depth.saturating_sub(1),
            Token::Sign(',') if depth == 1 => definitions.push(Vec::new()),
            _ => {}
        }
        if depth > 0 {
            if definitions.is_empty() {
                definitions.push(Vec::new());
            }
            let is_mark = depth == 1 && matches!(token, Token::Sign(_));
            if let Some(last) = definitions.last_mut().filter(|_| !is_mark) {
                last.push((depth, token));
            }
        }
    }
    let mut table = Table::default();
    let mut whole = Vec::new();
    for definition in &definitions {
        let outer: Vec<&Token> = definition.iter().filter(|(depth, _)| *depth == 1).map(|(_, token)| token).collect();
        let has = |words: &[&str]| outer.windows(words.len()).any(|own| own.iter().zip(words).all(|(t, w)| t.is(w)));
        let Some(first) = outer.first() else { continue };
        if ["CONSTRAINT", "PRIMARY", "UNIQUE", "CHECK", "FOREIGN"].iter().any(|word| first.is(word)) {
            let inner: Vec<&Token> = definition.iter().filter(|(depth, _)| *depth > 1).map(|(_, t)| t).collect();
            let is_one = !inner.contains(&&Token::Sign(','));
            if let Some(name) =
                inner.iter().find_map(|token| token.name()).filter(|_| is_one && has(&["PRIMARY", "KEY"]))
            {
                table.key = table.column(name).filter(|column| whole.contains(column)).or(table.key);
            }
            continue;
        }
        let is_computed = has(&["AS"]) && !has(&["STORED"]);
        let Some(name) = first.name().filter(|_| !is_computed && table.columns.len() < MOST_COLUMNS) else { continue };
        if outer.len() > 1 && outer[1].is("INTEGER") && outer.get(2).is_none_or(|token| !is_type_word(token)) {
            whole.push(table.columns.len());
            if has(&["PRIMARY", "KEY"]) && !has(&["PRIMARY", "KEY", "DESC"]) {
                table.key = Some(table.columns.len());
            }
        }
        table.columns.push(name.to_owned());
    }
    table
}

/// Whether a word goes on with the type of a column, instead of beginning what holds for it.
fn is_type_word(token: &Token) -> bool {
    let words = [
        "CONSTRAINT",
        "PRIMARY",
        "NOT",
        "NULL",
        "UNIQUE",
        "CHECK",
        "DEFAULT",
        "COLLATE",
        "REFERENCES",
        "GENERATED",
        "AS",
    ];
    !words.iter().any(|word| token.is(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_as_geopackage_programs_define_them() {
        for (sql, names, key) in [
            ("CREATE TABLE t (a, b TEXT)", &["a", "b"][..], None),
            (
                "CREATE TABLE \"a(b\" ( \"fid\" INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, `x \"y` REAL(10,2) DEFAULT (1,2), [z])",
                &["fid", "x \"y", "z"],
                Some(0),
            ),
            (
                "CREATE TABLE t (g BLOB, -- a, b\n id integer NOT NULL /* , c */ CHECK (id > 0), n TEXT DEFAULT 'a, (b', \
                 UNIQUE (n, g), PRIMARY KEY(\"ID\" AUTOINCREMENT)) STRICT",
                &["g", "id", "n"],
                Some(1),
            ),
            (
                "CREATE TABLE t (\"a\"\"b\" INTEGER PRIMARY KEY DESC, \"unique\" INT PRIMARY KEY)",
                &["a\"b", "unique"],
                None,
            ),
            (
                "CREATE TABLE t (a INTEGER, b AS (a + 1), c INT GENERATED ALWAYS AS (a) STORED, d)",
                &["a", "c", "d"],
                None,
            ),
            ("CREATE TABLE t (a INTEGER, b INTEGER, CONSTRAINT k PRIMARY KEY (a, b))", &["a", "b"], None),
            ("CREATE TABLE t (größe REAL, a$1 BIG INTEGER)", &["größe", "a$1"], None),
            ("CREATE TABLE t", &[], None),
            ("CREATE TABLE t (a, \"b", &["a", "b"], None),
        ] {
            let table = columns_of(sql);
            assert_eq!(
                (table.columns.as_slice(), table.key),
                (&names.iter().map(|n| (*n).to_owned()).collect::<Vec<_>>()[..], key),
                "{sql}"
            );
        }
    }

    #[test]
    fn varints_of_geopackage_rows_have_one_to_nine_bytes() {
        assert_eq!(varint(&[0x7f, 9]), Some((127, &[9][..])));
        assert_eq!(varint(&[0x81, 0x00]), Some((128, &[][..])));
        assert_eq!(varint(&[0xff; 10]), Some((u64::MAX, &[0xff][..])));
        assert_eq!(varint(&[0xff; 8]), None);
    }
}
