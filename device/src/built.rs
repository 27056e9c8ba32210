//! Effects that this card is built with.
//!
//! Each of these effects is a feature of this package; all are on unless they are left out (`--no-default-features`).
//! What is left out leaves no code: whatever only the effect needs is [`Called`] with its key, a type that has no value
//! where the effect is left out, so that the compiler drops every branch that could only be taken with one. The card then
//! says in CAPABILITY_EFFECTS that it has no such unit, and the firmware refuses draws that call for it.
//!
//! That is here to be measured: an effect that is there and not called must cost what one costs that is not there
//! (`.ci/overhead`). Duties: the keys, the bits of CAPABILITY_EFFECTS. Inputs: features. Clocks: none.

use std::ops::Deref;
use zga_abi::Effects;

/// Stands for an effect. There is no value where the card is built without it.
pub trait Key: Sized {
    /// The key, if there is one.
    fn built() -> Option<Self>;
}

macro_rules! keys {
    ($($(#[$text:meta])* $key:ident: $($feature:literal)|+;)*) => {$(
        $(#[$text])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct $key(
            #[cfg(any($(feature = $feature),+))] (),
            #[cfg(not(any($(feature = $feature),+)))] std::convert::Infallible,
        );

        impl Key for $key {
            #[inline(always)]
            fn built() -> Option<Self> {
                #[cfg(any($(feature = $feature),+))]
                let key = Some($key(()));
                #[cfg(not(any($(feature = $feature),+)))]
                let key = None;
                key
            }
        }
    )*};
}

keys! {
    /// Textures.
    TextureKey: "texture";
    /// Texels that decide visibility.
    PunchThroughKey: "punch-through";
    /// Lights.
    LightKey: "light";
    /// Fog and depth cueing.
    FogKey: "fog";
    /// Colours that go through more than interpolation.
    ShadingKey: "texture" | "light" | "fog";
    /// Translucency where a pixel has one sample.
    LayerKey: "layers";
    /// Sub-pixel masks.
    SubpixelKey: "subpixel";
    /// Stencil tests and the shadow bit.
    StencilKey: "stencil";
}

/// What a draw needs for an effect that it calls for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Called<K, T> {
    value: T,
    key: K,
}

impl<K: Key, T> Called<K, T> {
    /// What `value` makes, if the card is built with the effect.
    #[inline(always)]
    pub fn new(value: impl FnOnce() -> T) -> Option<Called<K, T>> {
        K::built().map(|key| Called { value: value(), key })
    }
}

impl<K, T> Deref for Called<K, T> {
    type Target = T;

    #[inline(always)]
    fn deref(&self) -> &T {
        &self.value
    }
}

/// Effects that this card has units for, as in CAPABILITY_EFFECTS.
pub const EFFECTS: Effects = {
    let mut effects = Effects::DEPTH.union(Effects::GOURAUD).union(Effects::PERSPECTIVE).union(Effects::DECAL);
    if cfg!(feature = "texture") {
        effects = effects.union(Effects::TEXTURE).union(Effects::MIP_MAP);
    }
    if cfg!(feature = "punch-through") {
        effects = effects.union(Effects::PUNCH_THROUGH);
    }
    if cfg!(feature = "light") {
        effects = effects.union(Effects::LIGHT);
    }
    if cfg!(feature = "fog") {
        effects = effects.union(Effects::FOG);
    }
    if cfg!(feature = "layers") {
        effects = effects.union(Effects::BLEND);
    }
    if cfg!(feature = "subpixel") {
        effects = effects.union(Effects::ANTI_ALIAS);
    }
    if cfg!(feature = "stencil") {
        effects = effects.union(Effects::STENCIL);
    }
    effects
};
