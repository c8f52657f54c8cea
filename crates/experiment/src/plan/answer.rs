//! The exact answers a study is judged by: one for each point of its sweep, each made once.

use super::{Point, Study};
use crate::error::{Complaint, one_of};
use duhem::closed_form::{REFERENCES, Reference, ReferenceEntry};
use simulation::{PLANT_REFERENCES, PlantReference, PlantReferenceEntry};
use std::sync::OnceLock;

/// The exact answer at one point.
#[derive(Debug)]
pub enum Exact {
    /// A closed form, under an imposed motion.
    Closed(Box<dyn Reference>),
    /// A plant solved in two independent ways.
    Solved(Box<PlantReference>),
}

impl Exact {
    /// As what errors are taken against.
    pub fn reference(&self) -> &dyn Reference {
        match self {
            Self::Closed(reference) => reference.as_ref(),
            Self::Solved(reference) => reference.as_ref(),
        }
    }

    /// The two ways of a plant.
    pub fn solved(&self) -> Result<&PlantReference, String> {
        match self {
            Self::Solved(reference) => Ok(reference),
            Self::Closed(_) => Err("an imposed motion where a plant is needed".to_owned()),
        }
    }
}

#[derive(Debug, Clone, Copy)]
enum Entry {
    Closed(&'static ReferenceEntry),
    Plant(&'static PlantReferenceEntry),
}

/// The answers of a study.
#[derive(Debug)]
pub struct Answers {
    /// The name they have in the list.
    pub name: &'static str,
    entry: Entry,
    made: Vec<OnceLock<Result<Exact, String>>>,
}

impl Answers {
    /// The answers of this name, for so many points.
    pub(super) fn find(name: &str, plant: bool, points: usize) -> Result<Self, Complaint> {
        let (entry, known): (Option<Entry>, Vec<&str>) = if plant {
            let found = PLANT_REFERENCES.iter().find(|r| r.name == name).map(Entry::Plant);
            (found, PLANT_REFERENCES.iter().map(|r| r.name).collect())
        } else {
            let found = REFERENCES.iter().find(|r| r.name == name).map(Entry::Closed);
            (found, REFERENCES.iter().map(|r| r.name).collect())
        };
        let entry = entry
            .ok_or_else(|| Complaint::new("reference", format!("`{name}`"), one_of(name, known)))?;
        let name = match entry {
            Entry::Closed(entry) => entry.name,
            Entry::Plant(entry) => entry.name,
        };
        Ok(Self { name, entry, made: (0..points).map(|_| OnceLock::new()).collect() })
    }

    /// How they are obtained, for the report.
    pub(crate) fn words(&self) -> String {
        match self.entry {
            Entry::Closed(entry) => entry.name.to_owned(),
            Entry::Plant(entry) => {
                format!("{}: {}, against {}", entry.name, entry.ways[0], entry.ways[1])
            }
        }
    }

    /// The answer at a point of the study these are the answers of.
    pub(super) fn at(&self, study: &Study, point: usize) -> Result<&Exact, String> {
        let cell = self.made.get(point).ok_or("no such point of the sweep")?;
        let made = cell.get_or_init(|| self.make(study, point));
        made.as_ref().map_err(Clone::clone)
    }

    /// The closed form at a point over another span [s].
    pub(crate) fn closed(
        &self,
        study: &Study,
        point: &Point,
        span: (f64, f64),
    ) -> Result<Box<dyn Reference>, String> {
        let Entry::Closed(entry) = self.entry else {
            return Err("a plant where an imposed motion is needed".to_owned());
        };
        (entry.build)(&point.parameters, &study.input, &study.initial, span)
            .map_err(|e| e.to_string())
    }

    fn make(&self, study: &Study, point: usize) -> Result<Exact, String> {
        let point = &study.points[point];
        let span = (0.0, study.span);
        match self.entry {
            Entry::Closed(_) => self.closed(study, point, span).map(Exact::Closed),
            Entry::Plant(entry) => {
                let plant = point.plant.as_ref().ok_or("a plant's answer without a plant")?;
                let built =
                    (entry.build)(&point.parameters, plant, &study.input, &study.initial, span);
                built.map(|b| Exact::Solved(Box::new(b))).map_err(|e| e.to_string())
            }
        }
    }
}
