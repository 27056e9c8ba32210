//! The stencil test, and the shadow bit.

use zga_abi::format::{DepthFunction, StencilOperation};

/// A stencil test: the reference OP the stored value, both masked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StencilTest {
    /// OP.
    pub function: DepthFunction,
    /// Reference.
    pub reference: u8,
    /// Bits that are compared.
    pub read_mask: u8,
}

/// A stencil test, and what becomes of stencil values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stencil {
    /// The test.
    pub test: StencilTest,
    /// Bits that operations may change.
    pub write_mask: u8,
    /// Operations of the fragments of triangles whose vertices run counter-clockwise on the screen, of lines and points.
    pub front: StencilOperations,
    /// Operations of the fragments of other triangles.
    pub back: StencilOperations,
    /// Pixels that pass keep their colour.
    pub colour_off: bool,
}

/// What becomes of a pixel's stencil value when a fragment comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StencilOperations {
    /// It fails the stencil test.
    pub fail: StencilOperation,
    /// It passes the stencil test and fails the depth test.
    pub depth_fail: StencilOperation,
    /// It passes both.
    pub pass: StencilOperation,
}

impl StencilTest {
    /// Whether a stored value passes.
    #[must_use]
    #[inline(always)]
    pub const fn passes(&self, stored: u8) -> bool {
        let (reference, stored) = (self.reference & self.read_mask, stored & self.read_mask);
        match self.function {
            DepthFunction::Never => false,
            DepthFunction::Less => reference < stored,
            DepthFunction::Equal => reference == stored,
            DepthFunction::LessEqual => reference <= stored,
            DepthFunction::Greater => reference > stored,
            DepthFunction::NotEqual => reference != stored,
            DepthFunction::GreaterEqual => reference >= stored,
            DepthFunction::Always => true,
        }
    }
}

impl Stencil {
    /// What becomes of a stored value by an operation.
    #[must_use]
    #[inline(always)]
    pub const fn apply(&self, operation: StencilOperation, stored: u8) -> u8 {
        let result = match operation {
            StencilOperation::Keep => stored,
            StencilOperation::Zero => 0,
            StencilOperation::Replace => self.test.reference,
            StencilOperation::Increment => stored.saturating_add(1),
            StencilOperation::Decrement => stored.saturating_sub(1),
            StencilOperation::Invert => !stored,
            StencilOperation::IncrementWrap => stored.wrapping_add(1),
            StencilOperation::DecrementWrap => stored.wrapping_sub(1),
        };
        (stored & !self.write_mask) | (result & self.write_mask)
    }

    /// Whether an operation can change a value.
    #[must_use]
    pub fn changes_values(&self) -> bool {
        let all = |face: StencilOperations| [face.fail, face.depth_fail, face.pass];
        let mut operations = all(self.front).into_iter().chain(all(self.back));
        self.write_mask != 0 && operations.any(|operation| operation != StencilOperation::Keep)
    }

    /// Whether a fragment that fails a test can change a value.
    #[must_use]
    pub fn marks_failures(&self) -> bool {
        let failing = |face: StencilOperations| [face.fail, face.depth_fail];
        let mut operations = failing(self.front).into_iter().chain(failing(self.back));
        self.write_mask != 0 && operations.any(|operation| operation != StencilOperation::Keep)
    }
}

/// The shadow bit: pixels that are darkened when the opaque picture of a scene is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shadow {
    /// Pixels whose stencil value passes are in shadow.
    pub test: StencilTest,
    /// What is left of each channel, of 255.
    pub intensity: u8,
}
