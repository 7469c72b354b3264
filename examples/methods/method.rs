//! The methods: what each is called, and what the thesis says of it.

/// How a body is moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    Plain,
    Law,
    Graph,
    Stochastic,
    Pattern,
    Reduced,
}

impl Method {
    pub const ALL: [Self; 6] = [
        Self::Plain,
        Self::Law,
        Self::Graph,
        Self::Stochastic,
        Self::Pattern,
        Self::Reduced,
    ];

    pub const fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain rapier",
            Self::Law => "default law",
            Self::Graph => "graph-based",
            Self::Stochastic => "stochastic",
            Self::Pattern => "pattern-driven",
            Self::Reduced => "reduced model",
        }
    }

    /// For files.
    pub const fn key(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Law => "law",
            Self::Graph => "graph",
            Self::Stochastic => "stochastic",
            Self::Pattern => "pattern",
            Self::Reduced => "reduced",
        }
    }

    /// The column of thesis Table 7.1, criteria in its order: a tick, a dash or nothing. The first two are not in it.
    pub const fn thesis(self) -> Option<[&'static str; 7]> {
        match self {
            Self::Plain | Self::Law => None,
            Self::Graph => Some(["", "", "✓", "✓", "", "✓", ""]),
            Self::Stochastic => Some([""; 7]),
            Self::Pattern => Some(["✓", "", "✓", "✓", "✓", "✓", ""]),
            Self::Reduced => Some(["✓", "", "✓", "—", "—", "", ""]),
        }
    }

    /// Linear RGB.
    pub const fn color(self) -> [f32; 3] {
        match self {
            Self::Plain => [0.35, 0.35, 0.35],
            Self::Law => [0.10, 0.45, 0.12],
            Self::Graph => [0.80, 0.35, 0.03],
            Self::Stochastic => [0.10, 0.30, 0.75],
            Self::Pattern => [0.70, 0.10, 0.12],
            Self::Reduced => [0.45, 0.15, 0.60],
        }
    }
}
