//! Compares the reference pages of parameters and of the command line with the program.
//! `CONELAB_BLESS=1 cargo test --release --test pages` writes them again.

mod common;

use clap::CommandFactory;
use common::root;
use conelab::commands::Cli;
use conelab::graph::param::{Kind, Param, Value};
use conelab::lab::Workspace;
use indexmap::IndexMap;
use std::fmt::Write;

/// Graphs in the order of the page. Each tool's own graph (`preview`, `reference`) has its own page.
const GRAPHS: [&str; 10] = [
    "rays",
    "cones",
    "warps",
    "temporal",
    "thesis",
    "ddgi",
    "ssgi",
    "ssgi_rays",
    "lpv",
    "rsm",
];

/// A cell of a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

fn value(value: &Value) -> String {
    match value {
        Value::Vector(v) => {
            let numbers: Vec<String> = v.iter().map(f64::to_string).collect();
            format!("({})", numbers.join(", "))
        }
        Value::Float(v) => v.to_string(),
        other => other.to_string(),
    }
}

/// The values that a parameter accepts.
fn domain(param: &Param) -> String {
    let unit = if param.unit.is_empty() {
        String::new()
    } else {
        format!(" {}", param.unit)
    };
    let options = |names: &[String]| {
        let names: Vec<String> = names.iter().map(|n| format!("`{n}`")).collect();
        names.join(", ")
    };
    match (&param.kind, param.range) {
        (Kind::Bool, _) => "`true`, `false`".into(),
        (Kind::Choice(names), _) => options(names),
        (_, Some((low, high))) => format!("{low} to {high}{unit}"),
        _ => format!("number{unit}"),
    }
}

/// Help of a parameter and of its options.
fn help(param: &Param) -> String {
    let mut text = param.help.clone();
    for (option, help) in param.kind.options().iter().zip(&param.option_help) {
        if !help.is_empty() {
            let _ = write!(text, "<br>`{option}`: {help}");
        }
    }
    text
}

/// A declaration, with the graphs that have it as it is.
type Declared = (Param, Vec<&'static str>);

fn parameters() -> String {
    let home = Workspace::at(root().to_path_buf()).unwrap();
    let mut groups: IndexMap<String, Vec<Declared>> = IndexMap::new();
    for name in GRAPHS {
        let graph = home.read(&format!("{name}.ron")).unwrap();
        for param in graph.params.offered() {
            let group = groups.entry(param.group.clone()).or_default();
            let same = |(other, _): &&mut Declared| {
                other.name == param.name
                    && other.default == param.default
                    && domain(other) == domain(param)
                    && help(other) == help(param)
            };
            match group.iter_mut().find(same) {
                Some((_, graphs)) => graphs.push(name),
                None => group.push((param.clone(), vec![name])),
            }
        }
    }
    let mut page = String::from(
        "# Parameters\n\nThe parameters of all graphs, by the group under which the workbench shows them. Set one with \
         `--set NAME=VALUE`, in an experiment file, in a sweep, in the workbench, or in Python. `conelab graph GRAPH \
         --params` prints those of one graph. A parameter that has two rows has another default or range in the graphs of \
         the second.\n\nThis page is generated from `passes/`.\n",
    );
    for (group, list) in groups {
        let title = if group.is_empty() { "Other" } else { &group };
        let _ = write!(
            page,
            "\n## {title}\n\n| Parameter | Default | Values | Effect | Graphs |\n|---|---|---|---|---|\n"
        );
        for (param, graphs) in list {
            let graphs = if graphs.len() == GRAPHS.len() {
                "all".into()
            } else {
                graphs.join(", ")
            };
            let _ = writeln!(
                page,
                "| `{}` | {} | {} | {} | {graphs} |",
                param.name,
                cell(&value(&param.default)),
                cell(&domain(&param)),
                cell(&help(&param)),
            );
        }
    }
    page
}

/// Options and arguments of a command as a table.
fn options(command: &clap::Command) -> String {
    let mut rows = String::new();
    let listed = command
        .get_arguments()
        .filter(|a| !a.is_hide_set() && !["help", "version"].contains(&a.get_id().as_str()));
    for argument in listed {
        let names = argument.get_value_names().unwrap_or_default();
        let takes = argument.get_action().takes_values();
        let names: Vec<&str> = names.iter().map(AsRef::as_ref).filter(|_| takes).collect();
        let value = names.join(" ");
        let name = match (argument.get_long(), argument.get_short()) {
            (None, None) => value.clone(),
            (None, Some(short)) => format!("-{short} {value}"),
            (Some(long), None) => format!("--{long} {value}"),
            (Some(long), Some(short)) => format!("-{short}, --{long} {value}"),
        };
        let defaults = argument.get_default_values().iter();
        let defaults: Vec<_> = defaults.map(|v| v.to_string_lossy()).collect();
        let values = argument.get_possible_values();
        let values: Vec<String> = values
            .iter()
            .filter(|_| takes)
            .map(|v| format!("`{}`", v.get_name()))
            .collect();
        let long = argument.get_long_help().or(argument.get_help());
        let mut help = long.map(ToString::to_string).unwrap_or_default();
        if !help.ends_with(['.', '?']) {
            help.push('.');
        }
        if !values.is_empty() {
            let _ = write!(help, " Values: {}.", values.join(", "));
        }
        if takes && !defaults.is_empty() {
            let _ = write!(help, " Default: `{}`.", defaults.join(" "));
        }
        if let Some(variable) = argument.get_env() {
            let _ = write!(help, " Environment: `{}`.", variable.to_string_lossy());
        }
        let _ = writeln!(rows, "| `{}` | {} |", name.trim(), cell(&help));
    }
    match rows.is_empty() {
        true => String::new(),
        false => format!("\n| Option | Meaning |\n|---|---|\n{rows}"),
    }
}

fn command_line() -> String {
    let mut program = Cli::command().disable_help_subcommand(true);
    program.build();
    let mut page = String::from(
        "# Command line\n\nEvery command of `conelab` with its options. `conelab COMMAND --help` prints the same. Exit \
         code 0: success; 1: a failure, or a difference that the command looks for; 2: a mistake in the command line.\n\n\
         This page is generated from the program.\n\n| Command | Use |\n|---|---|\n",
    );
    let commands = || program.get_subcommands().filter(|c| !c.is_hide_set());
    let about = |c: &clap::Command| c.get_about().map(ToString::to_string).unwrap_or_default();
    for command in commands() {
        let name = command.get_name();
        let _ = writeln!(page, "| [`{name}`](#{name}) | {} |", cell(&about(command)));
    }
    for command in commands() {
        let usage = command.clone().render_usage().to_string();
        let usage = usage.trim_start_matches("Usage: ");
        let text = command.get_long_about().or(command.get_about());
        let text = text.map(ToString::to_string).unwrap_or_default();
        let _ = write!(
            page,
            "\n## {}\n\n{text}\n\n```text\n{usage}\n```\n{}",
            command.get_name(),
            options(command)
        );
    }
    page
}

#[test]
fn generated_pages_are_up_to_date() {
    for (page, text) in [
        ("docs/parameters.md", parameters()),
        ("docs/command-line.md", command_line()),
    ] {
        let path = root().join(page);
        if std::env::var_os("CONELAB_BLESS").is_some() {
            std::fs::write(&path, &text).unwrap();
        }
        let written = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(
            written == text,
            "{page} differs from the program: CONELAB_BLESS=1 cargo test --release --test pages writes it again"
        );
    }
}

#[test]
fn the_gallery_shows_every_scene() {
    let page = std::fs::read_to_string(root().join("docs/gallery.md")).unwrap();
    for (name, about) in conelab::scene::builtin::list() {
        let picture = format!("gallery/{name}.jpg");
        assert!(
            root().join("docs").join(&picture).is_file(),
            "no docs/{picture}: scripts/figures.py gallery={name}"
        );
        assert!(
            page.contains(&format!("]({picture})")) && page.contains(about),
            "docs/gallery.md does not show '{name}', {about}: scripts/figures.py"
        );
    }
}

#[test]
fn every_page_is_in_the_site() {
    let contents = std::fs::read_to_string(root().join("docs/SUMMARY.md")).unwrap();
    for entry in std::fs::read_dir(root().join("docs")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        if name.ends_with(".md") && name != "SUMMARY.md" {
            assert!(
                contents.contains(&format!("]({name})")),
                "docs/SUMMARY.md lacks {name}"
            );
        }
    }
}
