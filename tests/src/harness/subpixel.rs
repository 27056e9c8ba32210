//! Samples of a pixel: the registers from SUBPIXEL_GRID to SUBPIXEL_EDGES.

/// Samples of a pixel, columns x rows; the number is the register's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Grid {
    /// One, at the centre.
    #[default]
    Off = 0,
    /// 16 samples.
    Grid4x4 = 1,
    /// 32 samples.
    Grid8x4 = 2,
    /// 64 samples.
    Grid8x8 = 3,
}

impl Grid {
    /// Those with samples.
    pub const ALL: [Self; 3] = [Self::Grid4x4, Self::Grid8x4, Self::Grid8x8];

    /// Columns and rows.
    #[must_use]
    pub const fn size(self) -> [u32; 2] {
        match self {
            Self::Off => [1, 1],
            Self::Grid4x4 => [4, 4],
            Self::Grid8x4 => [8, 4],
            Self::Grid8x8 => [8, 8],
        }
    }
}

/// How fragments that share samples are ordered; the number is the register's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// By the depth at the pixel's centre.
    Centre = 0,
    /// By ranges of depth, sample by sample where they overlap.
    #[default]
    Search = 1,
    /// Sample by sample.
    Exhaustive = 2,
}

impl Order {
    /// All three.
    pub const ALL: [Self; 3] = [Self::Centre, Self::Search, Self::Exhaustive];
}

/// Space in which samples are averaged; the number is the register's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Resolve {
    /// The frame buffer's values.
    #[default]
    Values = 0,
    /// Linear light.
    Linear = 1,
}

impl Resolve {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Values, Self::Linear];
}

/// Which edges are anti-aliased; the number is the register's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Edges {
    /// Those of every triangle.
    #[default]
    All = 0,
    /// Those that a triangle does not share with another of its surface.
    Borders = 1,
}

impl Edges {
    /// Both.
    pub const ALL: [Self; 2] = [Self::All, Self::Borders];
}

/// The registers; sampled by BEGIN_SCENE.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Subpixel {
    /// Samples of a pixel.
    pub grid: Grid,
    /// How fragments are ordered.
    pub depth: Order,
    /// How samples are averaged.
    pub resolve: Resolve,
    /// Fragments that the lists of one line of pixels have room for.
    pub pool: u32,
    /// Which edges are anti-aliased.
    pub edges: Edges,
}

impl Default for Subpixel {
    /// As the card resets them: no grid.
    fn default() -> Self {
        Self { grid: Grid::Off, depth: Order::Search, resolve: Resolve::Values, pool: 1 << 20, edges: Edges::All }
    }
}

impl Subpixel {
    /// A grid with the card's reset values.
    #[must_use]
    pub fn on(grid: Grid) -> Self {
        Self { grid, ..Self::default() }
    }

    /// The same grid, ordered sample by sample.
    #[must_use]
    pub fn exhaustive(grid: Grid) -> Self {
        Self { depth: Order::Exhaustive, ..Self::on(grid) }
    }

    /// The same, at borders alone.
    #[must_use]
    pub fn borders(self) -> Self {
        Self { edges: Edges::Borders, ..self }
    }

    /// SUBPIXEL_GRID to SUBPIXEL_EDGES.
    #[must_use]
    pub const fn words(&self) -> [u32; 5] {
        [self.grid as u32, self.depth as u32, self.resolve as u32, self.pool, self.edges as u32]
    }
}
