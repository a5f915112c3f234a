//! From a plan to files: rows, tables, figures, claims, one page. Nothing is written before everything is known.

use std::path::PathBuf;

use rayon::prelude::*;
use reports::{Block, Claim, Figure, OutputDir, Section};

use crate::options::{Common, Format};
use crate::page;
use crate::parts;
use crate::parts::Each;
use crate::plan::Plan;
use crate::provenance;
use crate::provenance::Manifest;
use crate::shards::Shards;
use crate::teach;
use measure::adequacy::Adequacy;
use measure::convergence::Convergence;
use measure::drift::DriftStudy;
use measure::error::Error;
use measure::files;
use measure::loops::Loops;
use measure::rotation::Rotation;
use measure::stability::Stability;
use measure::study::{Derived, Selection, Study};
use measure::tradeoff::Tradeoff;

/// What a study has made: files to be written, and its part of the page.
pub struct Product {
    /// Name and content of each file.
    pub files: Vec<(String, Vec<u8>)>,
    /// Its part of the page.
    pub section: Section,
    /// Its verdicts.
    pub claims: Vec<Claim>,
}

pub use crate::parts::REPORT;
pub(crate) use crate::parts::refuse_schemes;

/// Claims, and where the rows come from that they were judged by.
pub struct Judged {
    /// Its verdicts.
    pub claims: Vec<Claim>,
    /// Where the rows come from.
    pub manifest: Manifest,
    /// Whether this is all that a study or the report has to say: a run of the default plan.
    pub is_full: bool,
}

impl Judged {
    fn of(claims: Vec<Claim>, manifest: Manifest) -> Self {
        let is_full = manifest.plan == Plan::default();
        Judged { claims, manifest, is_full }
    }

    /// The exit code: 1 if a claim is broken, or if one of a full run was not tested.
    pub fn code(&self) -> u8 {
        reports::exit_code(&self.claims, self.is_full)
    }
}

/// Where rows come from, and in which form charts are wanted.
pub struct Source {
    rows: Rows,
    format: Format,
    manifest: Manifest,
}

enum Rows {
    Measured(Box<Selection>),
    Files(PathBuf),
    Shards(Shards),
}

impl Source {
    /// What the flags ask for.
    ///
    /// # Errors
    /// Bad input, named with its place and its remedy.
    pub fn of(common: &Common) -> Result<Self, Error> {
        let format = drawable(common.format)?;
        let selection = common.selection()?;
        let (rows, manifest) = match &common.from {
            Some(directory) => (Rows::Files(directory.clone()), Manifest::read(directory)?),
            None => (Rows::Measured(Box::new(selection)), Manifest::of(&common.plan)),
        };
        Ok(Source { rows, format, manifest })
    }

    fn rows<S: Study>(&mut self) -> Result<Vec<S::Row>, Error> {
        match &mut self.rows {
            Rows::Measured(selection) => {
                S::check_selection(selection)?;
                selection.progress.name(S::ID);
                Ok(files::in_order::<S>(S::measure(selection)))
            }
            Rows::Files(directory) => self.manifest.rows_of::<S>(directory),
            Rows::Shards(shards) => Ok(files::in_order::<S>(shards.rows_of::<S>()?)),
        }
    }

    /// Measures or reads the rows of one study and makes all that follows from them.
    ///
    /// # Errors
    /// Rows that cannot be read, or that have no form as text; figures that cannot be drawn.
    pub fn product<S: Study>(&mut self) -> Result<Product, Error> {
        let mut product = from_rows::<S>(&self.rows::<S>()?, &self.manifest.plan, self.format)?;
        if let Rows::Measured(selection) = &self.rows {
            for Derived { name, caption, csv, table } in S::timings(selection)? {
                product.files.push((format!("{name}.csv"), csv.into_bytes()));
                let block = Block::Table { caption: caption.to_owned(), table, csv: Some(format!("{name}.csv")) };
                product.section.blocks.push(block);
            }
        }
        Ok(product)
    }

    /// Every study of the report, in its order: measured one after the other, each on all cores, and then drawn and judged
    /// side by side.
    ///
    /// # Errors
    /// As [`Self::product`].
    pub fn all(&mut self) -> Result<Vec<Product>, Error> {
        let format = self.format;
        let mut made: Vec<Making> = Vec::new();
        let plan = self.manifest.plan.clone();
        macro_rules! measure {
            ($($study:ty),*) => {$(
                let rows = self.rows::<$study>()?;
                made.push(Box::new(move |plan| from_rows::<$study>(&rows, plan, format)));
            )*};
        }
        measure!(Convergence, DriftStudy, Rotation, Adequacy, Stability, Loops, Tradeoff);
        made.into_par_iter().map(|make| make(&plan)).collect()
    }
}

/// The form of the charts, if this program draws it.
fn drawable(format: Format) -> Result<Format, Error> {
    if format != Format::Svg && !reports::DRAWS_PNG {
        let message = "this program draws no PNG; build it with `cargo build --release --features png`";
        return Err(Error::plan("--format", message));
    }
    Ok(format)
}

/// The command that makes a figure again: the study, the figure's scene and the plan's flags.
fn command(study: &str, figure: &Figure, plan: &Plan) -> String {
    let scene = figure.scene.as_deref();
    let flags = scene.map_or_else(String::new, |scene| format!(" --scene {scene}")) + &plan.flags(scene);
    let separator = if flags.is_empty() { "" } else { " --" };
    format!("cargo run --release --bin {study}{separator}{flags}")
}

/// What follows from the rows of one study, still to be made.
type Making = Box<dyn FnOnce(&Plan) -> Result<Product, Error> + Send>;

/// All that follows from the rows of a study, without running anything.
///
/// # Errors
/// Rows or figures that have no form as text.
pub fn from_rows<S: Study>(rows: &[S::Row], plan: &Plan, format: Format) -> Result<Product, Error> {
    let mut files: Vec<(String, Vec<u8>)> =
        files::write::<S>(rows)?.into_iter().map(|(name, text)| (name, text.into_bytes())).collect();
    let of_rows: Vec<String> = files.iter().map(|(name, _)| name.clone()).collect();
    let claims = S::claims(rows);
    if let Some(id) = measure::claim::repeated(&claims) {
        let message =
            format!("two claims are named {id}: rows of a run stand twice or under another's name; run again");
        return Err(Error::plan(of_rows.join(", "), message));
    }
    let claims_csv = format!("{}-claims.csv", S::ID);
    files.push((claims_csv, reports::write_csv(&claims)?.into_bytes()));
    let mut figures = S::figures(rows);
    for figure in figures.iter_mut().filter(|figure| figure.command.is_empty()) {
        figure.command = command(S::ID, figure, plan);
    }
    let (mut blocks, mut linked) = (Vec::new(), Vec::new());
    for (figure, drawn) in drawn(figures, format)? {
        files.extend(drawn);
        if figure.on_page {
            blocks.push(Block::Figure(figure));
        } else {
            linked.push((figure.scene, (figure.title, format!("{}.{}", figure.id, format.ending()))));
        }
    }
    blocks.push(Block::Claims(claims.clone()));
    for Derived { name, caption, csv, table } in S::tables(rows)? {
        files.push((format!("{name}.csv"), csv.into_bytes()));
        blocks.push(Block::Table { caption: caption.to_owned(), table, csv: Some(format!("{name}.csv")) });
    }
    let section = page::section::<S>(of_rows, blocks, linked);
    Ok(Product { files, section, claims })
}

/// A figure and its files.
type Drawn = (Figure, Vec<(String, Vec<u8>)>);

fn drawn(figures: Vec<Figure>, format: Format) -> Result<Vec<Drawn>, Error> {
    let draw = |figure: Figure| {
        let svg = reports::svg(&figure)?;
        let mut files = Vec::new();
        if format != Format::Svg {
            files.push((format!("{}.png", figure.id), reports::png(&svg, &figure.id)?));
        }
        if format != Format::Png {
            files.push((format!("{}.svg", figure.id), svg.into_bytes()));
        }
        Ok((figure, files))
    };
    figures.into_par_iter().map(draw).collect()
}

/// Makes what the flags ask for of one study and writes its files.
///
/// # Errors
/// Bad input, or an output that cannot be written.
pub fn study<S: Study>(common: &Common) -> Result<(Judged, Section), Error> {
    parts::heeds::<S>(common)?;
    study_from::<S>(common, Source::of(common)?)
}

fn study_from<S: Study>(common: &Common, mut source: Source) -> Result<(Judged, Section), Error> {
    let out = OutputDir::create(common.out(S::ID))?;
    let Product { files, claims, section } = source.product::<S>()?;
    let manifest = source.manifest.sealed(&files)?;
    write(&out, S::ID, common, files, &manifest)?;
    Ok((Judged::of(claims, manifest), section))
}

/// Writes the files with plan and manifest in place of those that this program wrote there before, or of the files the charts
/// alone beside what is there.
pub(crate) fn write(
    out: &OutputDir,
    owner: &str,
    common: &Common,
    mut files: Vec<(String, Vec<u8>)>,
    manifest: &Manifest,
) -> Result<(), Error> {
    files.push((provenance::PLAN.to_owned(), manifest.plan.to_toml()?.into_bytes()));
    files.push((provenance::MANIFEST.to_owned(), manifest.to_json()?.into_bytes()));
    if common.figures_only {
        files.retain(|(name, _)| name.ends_with(".svg") || name.ends_with(".png"));
        return Ok(out.write_all(&files)?);
    }
    Ok(out.replace_all(owner, &files)?)
}

/// Makes the whole report and writes it.
///
/// # Errors
/// Bad input, or an output that cannot be written.
pub fn report(common: &Common) -> Result<Judged, Error> {
    report_from(common, Source::of(common)?)
}

/// Puts the shards of a program together and writes its files.
///
/// # Errors
/// Rows of a shard that cannot be read, or an output that cannot be written.
pub(crate) fn merged(common: &Common, shards: Shards) -> Result<Judged, Error> {
    let (program, manifest) = (shards.program().to_owned(), shards.manifest());
    let source = Source { rows: Rows::Shards(shards), format: drawable(common.format)?, manifest };
    if program == REPORT {
        return report_from(common, source);
    }
    let mut one = One { common, source: Some(source), judged: None };
    parts::each(&program, &mut one)?;
    one.judged.ok_or_else(|| Error::plan("merge", format!("'{program}' runs no study")))
}

/// The one study of a program.
struct One<'a> {
    common: &'a Common,
    source: Option<Source>,
    judged: Option<Judged>,
}

impl Each for One<'_> {
    fn on<S: Study>(&mut self) -> Result<(), Error> {
        if let Some(source) = self.source.take() {
            self.judged = Some(study_from::<S>(self.common, source)?.0);
        }
        Ok(())
    }
}

fn report_from(common: &Common, mut source: Source) -> Result<Judged, Error> {
    let out = OutputDir::create(common.out(REPORT))?;
    let products = source.all()?;
    let (mut files, mut sections, mut claims) = (Vec::new(), Vec::new(), Vec::new());
    for product in products {
        files.extend(product.files);
        sections.push(product.section);
        claims.extend(product.claims);
    }
    let rows = files.iter().find(|(name, _)| name == "convergence.csv").map_or(&[][..], |(_, csv)| csv);
    let (plan, about) = (&source.manifest.plan, source.manifest.lines());
    let teaching = teach::page(&String::from_utf8_lossy(rows), &plan.set, &about)?;
    files.push((teach::FILE.to_owned(), teaching.into_bytes()));
    let scenes = plan.selection()?.scenes;
    let html = page::html(sections, &scenes, about)?;
    files.push(("index.html".to_owned(), html.into_bytes()));
    let manifest = source.manifest.sealed(&files)?;
    write(&out, REPORT, common, files, &manifest)?;
    Ok(Judged::of(claims, manifest))
}
