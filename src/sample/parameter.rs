use super::{SampleError, Sampler};

/// Description of one parameter of a sampler, as shown to users.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Name in lower case, with words joined by hyphens.
    pub name: &'static str,
    /// Unit of the value, or the name of the things counted; empty for a plain number.
    pub unit: &'static str,
    /// Smallest and largest allowed value; both are allowed themselves.
    pub range: (f64, f64),
    /// `true` if only integers are allowed.
    pub whole: bool,
    /// Default value, or `None` if the default is not a number.
    pub default: Option<f64>,
    /// Text shown for a default that is not a number, such as “until points rest”.
    pub unset: &'static str,
    /// Effect of the parameter, and the source of its default.
    pub meaning: &'static str,
}

impl Parameter {
    /// Describes the range of allowed values for users, such as “1 to 1000” or “at least 0”.
    pub fn range_in_words(&self) -> String {
        let kind = if self.whole { "whole, " } else { "" };
        match self.range {
            (low, f64::INFINITY) => format!("{kind}at least {low}"),
            // cut off, not rounded: the number shown must itself be allowed
            (low, high) if high.to_string().len() > 7 && !self.whole => {
                format!("{low} to {}", (high * 1e4).floor() / 1e4)
            }
            (low, high) => format!("{kind}{low} to {high}"),
        }
    }

    /// Describes the default for users: the number, with four decimals if it is long, or a text.
    pub fn default_in_words(&self) -> String {
        let Some(value) = self.default else { return self.unset.to_owned() };
        let exact = value.to_string();
        if exact.len() <= 7 { exact } else { format!("{value:.4}") }
    }

    /// Converts the user's text to a value of this parameter; `sampler` is named in the error.
    fn parse(&self, sampler: &'static str, text: &str) -> Result<f64, SampleError> {
        let within = |v: &f64| (self.range.0..=self.range.1).contains(v) && (!self.whole || v.fract() == 0.);
        text.trim().parse::<f64>().ok().filter(within).ok_or_else(|| SampleError::Value {
            sampler,
            parameter: self.name,
            value: text.to_owned(),
            expected: format!("{} {}", self.range_in_words(), self.unit).trim_end().to_owned(),
        })
    }
}

/// Row of a sampler's table of parameters: the text shown to users, and access to the field.
///
/// The row contains no default, as `get` reads it from the sampler.
pub struct Setting<S> {
    /// Name of the parameter, see [`Parameter::name`].
    pub name: &'static str,
    /// Unit of the parameter, see [`Parameter::unit`].
    pub unit: &'static str,
    /// Range of allowed values, see [`Parameter::range`].
    pub range: (f64, f64),
    /// `true` if only integers are allowed, see [`Parameter::whole`].
    pub whole: bool,
    /// Text shown for a default that is not a number, see [`Parameter::unset`]; empty if the
    /// default is always a number.
    pub unset: &'static str,
    /// Effect of the parameter, see [`Parameter::meaning`].
    pub meaning: &'static str,
    /// Getter that returns the current value, or `None` if it is not a number.
    pub get: fn(&S) -> Option<f64>,
    /// Setter of the value, which must lie within the range.
    pub set: fn(&mut S, f64),
}

impl<S> Setting<S> {
    /// Describes the parameter for users, with the value that the sampler `of` has as its default.
    fn parameter(&self, of: &S) -> Parameter {
        let Self { name, unit, range, whole, unset, meaning, get, .. } = *self;
        Parameter { name, unit, range, whole, default: get(of), unset, meaning }
    }
}

/// Sampler that has parameters.
///
/// Implementors return `Some(self)` from [`Sampler::settable`].
pub trait Settable: Sampler + Clone + 'static {
    /// Table of the sampler's parameters.
    ///
    /// Parameters are set in the order of the table. If two parameters set the same field, the
    /// later one wins.
    const SETTINGS: &'static [Setting<Self>];
}

/// Access to the parameters of a sampler whatever its type, implemented for every [`Settable`] one.
pub trait Configure {
    /// Returns the parameters, in the order of the table, with this sampler's values as defaults.
    fn described(&self) -> Vec<Parameter>;

    /// Returns the same sampler with other parameters; each setting is a pair of name and value.
    ///
    /// If a name is repeated, its last value is used.
    ///
    /// # Errors
    /// Fails if a name belongs to no parameter, or a value is not a number in its range; the
    /// message says what can be set.
    fn configured(&self, settings: &[(&str, &str)]) -> Result<Box<dyn Sampler>, SampleError>;
}

impl<S: Settable> Configure for S {
    fn described(&self) -> Vec<Parameter> {
        S::SETTINGS.iter().map(|setting| setting.parameter(self)).collect()
    }

    fn configured(&self, settings: &[(&str, &str)]) -> Result<Box<dyn Sampler>, SampleError> {
        let parameters = self.described();
        let mut values = vec![None; parameters.len()];
        for (name, text) in settings {
            let place = parameters.iter().position(|p| p.name == *name);
            let place =
                place.ok_or_else(|| SampleError::unknown_parameter(self.name(), name, &parameters))?;
            values[place] = Some(parameters[place].parse(self.name(), text)?);
        }
        let mut new = self.clone();
        for (setting, value) in S::SETTINGS.iter().zip(values) {
            value.into_iter().for_each(|v| (setting.set)(&mut new, v));
        }
        Ok(Box::new(new))
    }
}

#[cfg(test)]
mod tests {
    use super::super::Frame;
    use super::*;
    use crate::geometry::Point;
    use rand::Rng;

    #[derive(Clone, Debug)]
    struct Tester {
        steps: Option<usize>,
        length: f64,
    }

    impl Sampler for Tester {
        fn name(&self) -> &'static str {
            "tester"
        }
        fn about(&self) -> &'static str {
            "a test"
        }
        fn settable(&self) -> Option<&dyn Configure> {
            Some(self)
        }
        /// Returns one point that shows the parameters set.
        fn fill(&self, _: usize, _: &Frame, _: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
            Ok(vec![Point::new(self.steps.map_or(-1., |s| s as f64), self.length)])
        }
    }

    impl Settable for Tester {
        const SETTINGS: &'static [Setting<Self>] = &[
            Setting {
                name: "steps",
                unit: "",
                range: (1., 10.),
                whole: true,
                unset: "until it rests",
                meaning: "a test",
                get: |t| t.steps.map(|s| s as f64),
                set: |t, v| t.steps = Some(v as usize),
            },
            Setting {
                name: "length",
                unit: "spacings",
                range: (0., f64::INFINITY),
                whole: false,
                unset: "",
                meaning: "a test",
                get: |t| Some(t.length),
                set: |t, v| t.length = v,
            },
        ];
    }

    const TESTER: Tester = Tester { steps: None, length: 0.5 };

    fn set(settings: &[(&str, &str)]) -> Result<Point, SampleError> {
        let window = crate::geometry::Window::unit_square();
        let frame = Frame::new(1, &window)?;
        let mut rng = <rand_chacha::ChaCha8Rng as rand::SeedableRng>::seed_from_u64(1);
        Ok(TESTER.configure(settings)?.fill(1, &frame, &mut rng)?[0])
    }

    #[test]
    fn values_are_set_by_name_and_the_last_holds() {
        assert_eq!(set(&[]).unwrap(), Point::new(-1., 0.5));
        let set = set(&[("steps", "4"), ("length", "0.25"), ("steps", "5")]).unwrap();
        assert_eq!(set, Point::new(5., 0.25));
    }

    #[test]
    fn defaults_are_those_of_the_sampler() {
        let words: Vec<String> = TESTER.parameters().iter().map(Parameter::default_in_words).collect();
        assert_eq!(words, ["until it rests", "0.5"]);
    }

    #[test]
    fn what_cannot_be_set_says_what_can() {
        let message = |settings: &[(&str, &str)]| set(settings).unwrap_err().to_string();
        for bad in ["0", "11", "2.5", "many", "nan", ""] {
            assert!(message(&[("steps", bad)]).contains("whole, 1 to 10"), "{bad}");
        }
        assert!(message(&[("length", "-1")]).contains("at least 0 spacings"));
        let unknown = message(&[("step", "3")]);
        assert!(unknown.contains("steps, length") && unknown.contains("did you mean steps?"), "{unknown}");
        let none = super::super::Uniform.configure(&[("steps", "3")]).err().unwrap().to_string();
        assert!(none.contains("has no parameters"), "{none}");
    }
}
