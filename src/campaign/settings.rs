//! Settings of a point: parameters of the graph and fields of the experiment.

use crate::diagnostics::{At, Diagnostic, Entries, Loc, RawText};
use crate::experiment::{Experiment, Field};
use crate::lab::LabError;
use std::path::Path;

/// Name and value as RON.
#[derive(Clone, Debug)]
pub struct Setting {
    /// A field of the experiment (`crate::experiment::FIELDS`), or a parameter.
    pub name: Loc<String>,
    /// RON.
    pub text: String,
}

/// Settings of a file.
pub fn settings(list: &Entries<RawText>) -> Vec<Setting> {
    list.0
        .iter()
        .map(|(name, value)| Setting::new(name, value))
        .collect()
}

/// Names and values as the lines of a text that stands for a file in messages, and as settings with
/// their places in it.
pub fn lines<'t>(
    list: impl IntoIterator<Item = (&'t str, &'t str)>,
    between: &str,
) -> (String, Vec<Setting>) {
    let (mut text, mut settings) = (String::new(), Vec::new());
    for (name, value) in list {
        let at = At {
            file: 0,
            offset: u32::try_from(text.len()).unwrap_or(0),
        };
        settings.push(Setting {
            name: Loc {
                value: name.into(),
                at,
            },
            text: value.into(),
        });
        text += &format!("{name}{between}{value}\n");
    }
    (text.trim_end_matches('\n').into(), settings)
}

/// Applies settings and returns their mistakes. Places refer to the experiment's last source.
/// Parameters are checked with their graph.
pub fn apply<'s>(
    experiment: &mut Experiment,
    settings: impl IntoIterator<Item = &'s Setting>,
    folder: &Path,
) -> Vec<Diagnostic> {
    let file = last_source(experiment);
    let mut errors = Vec::new();
    for setting in settings {
        if let Err(message) = setting.apply(experiment, file, folder) {
            errors.push(experiment.sources.error(
                At {
                    file,
                    offset: setting.name.at.offset,
                },
                message,
            ));
        }
    }
    errors
}

/// Sets parameters, even those named like a field. Places refer to the experiment's last source.
pub fn set_params<'s>(
    experiment: &mut Experiment,
    settings: impl IntoIterator<Item = &'s Setting>,
) {
    let file = last_source(experiment);
    settings
        .into_iter()
        .for_each(|s| s.set_param(experiment, file));
}

fn last_source(experiment: &Experiment) -> u32 {
    u32::try_from(experiment.sources.paths().count().saturating_sub(1)).unwrap_or(0)
}

/// Splits the text of a command line option into name and value: `NAME=VALUE`, or as `form` says.
pub fn named<'t>(option: &str, text: &'t str, form: &str) -> Result<(&'t str, &'t str), LabError> {
    let parts = text
        .split_once('=')
        .map(|(name, value)| (name.trim(), value))
        .filter(|parts| !parts.0.is_empty());
    parts.ok_or_else(|| LabError::Request(format!("{option} {text}: expected {form}")))
}

/// A setting, and the values in RON that it is varied over.
pub type Axis = (String, Vec<String>);

/// Splits the text of a command line option into a name and values: `NAME=VALUE,VALUE`, or as
/// `form` says. Commas inside brackets belong to a value.
pub fn axis(option: &str, text: &str, form: &str) -> Result<Axis, LabError> {
    let (name, list) = named(option, text, form)?;
    let mut depth = 0;
    let between = |c: char| {
        depth += i32::from(matches!(c, '(' | '[')) - i32::from(matches!(c, ')' | ']'));
        c == ',' && depth == 0
    };
    let values: Vec<String> = list.split(between).map(|v| v.trim().to_string()).collect();
    match values.iter().any(String::is_empty) {
        true => Err(LabError::Request(format!(
            "{option} {text}: expected {form}"
        ))),
        false => Ok((name.into(), values)),
    }
}

impl Setting {
    /// Places of messages are those of the value.
    pub fn new(name: &Loc<String>, value: &Loc<RawText>) -> Setting {
        Setting {
            name: Loc {
                value: name.value.clone(),
                at: value.at,
            },
            text: value.value.0.clone(),
        }
    }

    fn apply(&self, experiment: &mut Experiment, file: u32, folder: &Path) -> Result<(), String> {
        match Field::of(&self.name.value) {
            Some(field) => field.set(
                experiment,
                &self.text,
                folder,
                At {
                    file,
                    offset: self.name.at.offset,
                },
            )?,
            None => self.set_param(experiment, file),
        }
        Ok(())
    }

    fn set_param(&self, experiment: &mut Experiment, file: u32) {
        let at = At {
            file,
            offset: self.name.at.offset,
        };
        experiment.params.push((
            Loc {
                value: self.name.value.clone(),
                at,
            },
            self.text.clone(),
        ));
    }
}
