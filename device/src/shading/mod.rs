//! Shading: the colour of what is seen. Runs once for each visible pixel, after visibility.
//!
//! | file | part |
//! | --- | --- |
//! | [`source`] | vertices' places and colours, until a primitive is seen |
//! | [`plane`] | colour interpolators: flat, affine (integer), perspective-correct (f32) |
//! | [`parameters`] | what vertices carry beside a colour, as planes |
//! | [`pixel`] | what follows the interpolated colour: light, texture, fog |
//! | [`rare`] | the same for lines' ends and for slivers in perspective, pixel by pixel |
//! | [`resolve`] | runs of visible pixels become frame buffer pixels |
//! | [`scattered`] | colours at places that lie anywhere, 16 at a time |
//! | [`light`] | colours of vertices and pixels under lights |
//! | [`fog`] | fog and depth cueing |
//! | [`levels`] | products and mixtures of 8-bit levels |
//! | [`math`] | powers and directions for both |
//!
//! Clocks: 1 for each interpolated pixel (four interpolators side by side); flat colours cost none.
//! The clocks are those of a card that shades each fragment that passes: 1 for each `colour.writes`
//! of a Gouraud draw. That the host shades only what stays visible shows in host time alone.

pub mod fog;
pub mod levels;
pub mod light;
pub mod math;
pub mod parameters;
pub mod pixel;
pub mod plane;
pub mod rare;
pub mod resolve;
pub mod scattered;
pub mod source;
