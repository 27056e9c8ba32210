//! Light records in video memory.

use bytemuck::{Pod, Zeroable};

/// Most lights of a draw.
pub const MOST_LIGHTS: u32 = 256;

/// A light, as it stands in video memory from LIGHT_BASE on: 16 words. Numbers that are not finite count as 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct LightRecord {
    /// Code of a [`crate::format::LightType`]; others count as directional.
    pub kind: u32,
    /// Eye space; point and spot lights.
    pub position: [f32; 3],
    /// Eye space: direction of the rays; directional and spot lights.
    pub direction: [f32; 3],
    /// Distance past which a point or spot light has no effect, eye space; 0 or less is without end.
    pub cut_off: f32,
    /// How fast a spot light falls off from its axis, 0..=128.
    pub spot_exponent: f32,
    /// RGBA of diffuse light and highlights, R in 7:0; alpha is not in use.
    pub colour: u32,
    /// RGBA that it adds everywhere within its reach; alpha is not in use.
    pub ambient: u32,
    /// 0.
    pub reserved: [u32; 5],
}

/// Bytes of a record.
pub const LIGHT_BYTES: u32 = size_of::<LightRecord>() as u32;
