use super::SampleError;

/// A number that a sampler takes. The command line sets it by `--set name=value`, and `sample --list` shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Its name: lower case, words joined by hyphens.
    pub name: &'static str,
    /// What it counts or is measured in; empty for a plain number.
    pub unit: &'static str,
    /// Least and greatest value, both allowed.
    pub range: (f64, f64),
    /// Only whole numbers are allowed.
    pub whole: bool,
    /// What holds if it is not set, in words or digits.
    pub default: &'static str,
    /// What it does, and where its default comes from.
    pub meaning: &'static str,
}

impl Parameter {
    /// The range as a user reads it: “1 to 1000”, “at least 0”.
    pub fn range_in_words(&self) -> String {
        let kind = if self.whole { "whole, " } else { "" };
        match self.range {
            (low, f64::INFINITY) => format!("{kind}at least {low}"),
            (low, high) => format!("{kind}{low} to {high}"),
        }
    }

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

/// Values read from `name=value` pairs and found to be in range.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Values(Vec<(&'static str, f64)>);

impl Values {
    /// The values that `settings` (name, value) give to `parameters` of `sampler`; the last one holds if there are two.
    ///
    /// # Errors
    /// If a name is none of theirs, or a value is not a number in its range; the message says what could be set.
    pub fn read(
        sampler: &'static str,
        parameters: &[Parameter],
        settings: &[(&str, &str)],
    ) -> Result<Self, SampleError> {
        let mut values = Vec::new();
        for (name, text) in settings {
            let parameter = parameters
                .iter()
                .find(|p| p.name == *name)
                .ok_or_else(|| SampleError::unknown_parameter(sampler, name, parameters))?;
            values.push((parameter.name, parameter.parse(sampler, text)?));
        }
        Ok(Self(values))
    }

    /// The value of a parameter, if it was set.
    pub fn get(&self, name: &str) -> Option<f64> {
        self.0.iter().rev().find(|(n, _)| *n == name).map(|(_, v)| *v)
    }

    /// The value of a whole parameter, if it was set.
    pub fn count(&self, name: &str) -> Option<usize> {
        self.get(name).map(|v| v as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEPS: Parameter =
        Parameter { name: "steps", unit: "", range: (1., 10.), whole: true, default: "3", meaning: "a test" };
    const LENGTH: Parameter = Parameter {
        name: "length",
        unit: "spacings",
        range: (0., f64::INFINITY),
        whole: false,
        default: "1",
        meaning: "a test",
    };

    fn read(settings: &[(&str, &str)]) -> Result<Values, SampleError> {
        Values::read("tester", &[STEPS, LENGTH], settings)
    }

    #[test]
    fn values_are_read_by_name_and_the_last_holds() {
        let values = read(&[("steps", "4"), ("length", "0.25"), ("steps", "5")]).unwrap();
        assert_eq!((values.count("steps"), values.get("length")), (Some(5), Some(0.25)));
        assert_eq!(read(&[]).unwrap().get("steps"), None);
    }

    #[test]
    fn what_cannot_be_set_says_what_can() {
        let message = |settings: &[(&str, &str)]| read(settings).unwrap_err().to_string();
        for bad in ["0", "11", "2.5", "many", "nan", ""] {
            assert!(message(&[("steps", bad)]).contains("whole, 1 to 10"), "{bad}");
        }
        assert!(message(&[("length", "-1")]).contains("at least 0 spacings"));
        let unknown = message(&[("step", "3")]);
        assert!(unknown.contains("steps, length") && unknown.contains("did you mean steps?"), "{unknown}");
        let none = Values::read("tester", &[], &[("steps", "3")]).unwrap_err().to_string();
        assert!(none.contains("has no parameters"), "{none}");
    }
}
