//! A parameter that changes from frame to frame.

use super::motion::Motion;
use crate::graph::param::{Param, Params, Value};

/// Values of a moving parameter by frame.
#[derive(Clone, Debug)]
pub struct ParamTrack {
    pub name: String,
    start: Value,
    steps: Steps,
}

#[derive(Clone, Debug)]
enum Steps {
    /// Step from frame to frame, added to the start.
    Step(Vec<f64>),
    /// Values of the measured frames.
    Values(Vec<Value>),
}

impl ParamTrack {
    /// Values of a motion's parameter over `warmup` frames and `frames` measured ones. `None` for
    /// other motions.
    pub fn of(
        motion: &Motion,
        params: &Params,
        warmup: usize,
        frames: usize,
    ) -> Result<Option<ParamTrack>, String> {
        let Motion::Parameter { name, step, values } = motion else {
            return Ok(None);
        };
        let mut own = params.clone();
        // The graph's message suggests the nearest name.
        let (Some(param), Some(start)) = (params.param(name), params.get(name)) else {
            return Err(own.set(name, "0").err().unwrap_or_default());
        };
        if param.is_compiled() {
            return Err(format!(
                "'{name}' is compiled into the shaders and cannot move"
            ));
        }
        let steps = match step {
            Some(step) if values.is_empty() => Steps::Step(numbers(param, &step.0)?),
            None if !values.is_empty() => Steps::Values(
                values
                    .iter()
                    .map(|v| param.parse(&v.0))
                    .collect::<Result<_, String>>()?,
            ),
            _ => {
                return Err(format!(
                    "a motion of '{name}' needs either a `step` or `values`"
                ));
            }
        };
        let track = ParamTrack {
            name: name.clone(),
            start: start.clone(),
            steps,
        };
        for number in [-(warmup as i64), frames as i64 - 1] {
            param
                .check(&track.at(number))
                .map_err(|e| format!("at frame {number}: {e}"))?;
        }
        Ok(Some(track))
    }

    /// The value at a frame, see [`Motion::frame_state`].
    pub fn at(&self, number: i64) -> Value {
        match (&self.steps, &self.start) {
            (Steps::Values(list), _) => {
                let last = list.len().saturating_sub(1);
                let index = usize::try_from(number).unwrap_or(0).min(last);
                list.get(index).unwrap_or(&self.start).clone()
            }
            (Steps::Step(step), Value::Float(v)) => {
                Value::Float(v + number as f64 * step.first().unwrap_or(&0.0))
            }
            (Steps::Step(step), Value::Vector(v)) => Value::Vector(
                v.iter()
                    .zip(step)
                    .map(|(v, s)| v + number as f64 * s)
                    .collect(),
            ),
            (Steps::Step(_), other) => other.clone(),
        }
    }
}

/// Step in the parameter's kind. Its range does not apply.
fn numbers(param: &Param, text: &str) -> Result<Vec<f64>, String> {
    let free = Param {
        range: None,
        ..param.clone()
    };
    match free.parse(text)? {
        Value::Float(v) => Ok(vec![v]),
        Value::Vector(v) => Ok(v),
        _ => Err(format!("'{}' has no steps: give its `values`", param.name)),
    }
}
