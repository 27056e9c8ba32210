//! Every code in a packet or register comes back from the value it stands for.

use crate::FaultCode;
use crate::format::{
    BitmapFormat, BlendMode, ComposeOperator, DepthFormat, DepthFunction, FogFunction, HiddenSurface, LightType,
    PictureFormat, PixelFormat, RasterOperation, Repeat, StretchFilter, SubpixelDepth, SubpixelEdges, SubpixelGrid,
    SubpixelResolve, TextureFilter, TextureFormat, TextureFunction, Topology,
};
use crate::light::{LIGHT_BYTES, LightRecord, MOST_LIGHTS};
use crate::packet::{DrawFlags, MAX_PAYLOAD, Opcode, header, payload_words};
use std::collections::HashSet;
use std::vec::Vec;

// Enumerations -------------------------------------------------------------------------------

#[test]
fn opcode_codes_round_trip_and_no_other_code_is_one() {
    for &opcode in Opcode::ALL {
        assert_eq!(Opcode::from_code(opcode as u32), Some(opcode));
        assert!(opcode as u32 <= 0xFF, "{}", opcode.name());
        assert!(!opcode.doc().trim().is_empty(), "{}", opcode.name());
    }
    let known = (0..=0xFFFF).filter_map(Opcode::from_code).count();
    assert_eq!(known, Opcode::ALL.len());
}

#[test]
fn fault_codes_round_trip_and_zero_is_none() {
    for &code in FaultCode::ALL {
        assert_eq!(FaultCode::from_code(code as u32), Some(code));
        assert!(!code.doc().trim().is_empty(), "{}", code.name());
    }
    let known = (0..=0xFFFF).filter_map(FaultCode::from_code).count();
    assert_eq!(known, FaultCode::ALL.len());
    assert_eq!(FaultCode::from_code(0), None);
}

/// Every code of an enumeration comes back; codes from 0 up to `$bits` bits beyond it mean nothing.
macro_rules! round_trips {
    ($($test:ident: $type:ident, $bits:literal;)+) => { $(
        #[test]
        fn $test() {
            let found: Vec<_> = (0..1 << $bits).filter_map($type::from_code).collect();
            assert_eq!(found, $type::ALL);
            for (code, value) in (0..).zip($type::ALL) {
                assert_eq!(value.code(), code);
                assert_eq!(value.name().to_lowercase(), value.name());
            }
            let names: HashSet<_> = $type::ALL.iter().map(|v| v.name()).collect();
            assert_eq!(names.len(), $type::ALL.len());
            assert_eq!($type::from_code(u32::MAX), None);
        }
    )+ };
}

round_trips! {
    pixel_format_codes_round_trip: PixelFormat, 8;
    bitmap_format_codes_round_trip: BitmapFormat, 8;
    picture_format_codes_round_trip: PictureFormat, 8;
    compose_operator_codes_round_trip: ComposeOperator, 8;
    repeat_codes_round_trip: Repeat, 8;
    raster_operation_codes_round_trip: RasterOperation, 8;
    stretch_filter_codes_round_trip: StretchFilter, 8;
    depth_function_codes_round_trip: DepthFunction, 8;
    topology_codes_round_trip: Topology, 8;
    hidden_surface_codes_round_trip: HiddenSurface, 8;
    subpixel_grid_codes_round_trip: SubpixelGrid, 8;
    subpixel_depth_codes_round_trip: SubpixelDepth, 8;
    subpixel_resolve_codes_round_trip: SubpixelResolve, 8;
    subpixel_edges_codes_round_trip: SubpixelEdges, 8;
    texture_format_codes_round_trip: TextureFormat, 8;
    texture_filter_codes_round_trip: TextureFilter, 8;
    texture_function_codes_round_trip: TextureFunction, 8;
    blend_mode_codes_round_trip: BlendMode, 8;
    fog_function_codes_round_trip: FogFunction, 8;
    light_type_codes_round_trip: LightType, 8;
}

#[test]
fn subpixel_grid_names_are_columns_by_rows_and_samples_their_product() {
    let sizes = [("off", [1, 1], 1), ("4x4", [4, 4], 16), ("8x4", [8, 4], 32), ("8x8", [8, 8], 64)];
    let found: Vec<_> = SubpixelGrid::ALL.iter().map(|grid| (grid.name(), grid.size(), grid.samples())).collect();
    assert_eq!(found, sizes);
    assert_eq!(
        SubpixelDepth::ALL.iter().map(|mode| mode.name()).collect::<Vec<_>>(),
        ["centre", "search", "exhaustive"]
    );
    assert_eq!(SubpixelResolve::ALL.iter().map(|mode| mode.name()).collect::<Vec<_>>(), ["values", "linear"]);
    assert_eq!(SubpixelEdges::ALL.iter().map(|mode| mode.name()).collect::<Vec<_>>(), ["all", "borders"]);
}

#[test]
fn header_opcode_and_length_come_back() {
    for &opcode in Opcode::ALL {
        for payload in [0, 1, 1000, MAX_PAYLOAD] {
            let word = header(opcode, payload);
            assert_eq!(Opcode::from_code(word >> 24), Some(opcode));
            assert_eq!(word & 0x00F0_0000, 0);
            assert_eq!(payload_words(word), payload);
        }
    }
    assert_eq!(header(Opcode::Fence, 1), 0x3000_0001);
}

#[test]
fn draw_flags_round_trip_and_reserved_bits_are_refused() {
    let valid: Vec<_> = (0..0x1000).filter(|&code| DrawFlags::from_code(code).is_some()).collect();
    // 4 topologies, indexed or not, colours, normals, coordinates or not.
    assert_eq!(valid.len(), 64);
    for code in valid {
        assert_eq!(DrawFlags::from_code(code).map(DrawFlags::code), Some(code));
    }
    for bit in [2, 3, 5, 6, 7].into_iter().chain(11..32) {
        assert_eq!(DrawFlags::from_code(1 << bit), None);
    }
    let words = |code| DrawFlags::from_code(code).map(DrawFlags::vertex_words);
    let formats = [0x000, 0x100, 0x200, 0x300, 0x400, 0x500, 0x600, 0x700];
    assert_eq!(formats.map(words), [3, 4, 6, 7, 5, 6, 8, 9].map(Some));
}

#[test]
fn topology_primitives_leave_incomplete_ones_out() {
    let made = |topology: Topology| [0, 1, 2, 3, 4, 7].map(|n| topology.primitives(n));
    assert_eq!(made(Topology::Triangles), [0, 0, 0, 1, 1, 2]);
    assert_eq!(made(Topology::Lines), [0, 0, 1, 1, 2, 3]);
    assert_eq!(made(Topology::Points), [0, 1, 2, 3, 4, 7]);
    assert_eq!(made(Topology::LineStrip), [0, 0, 1, 2, 3, 6]);
}

// Formats ------------------------------------------------------------------------------------

#[test]
fn pixel_format_encode_puts_channels_where_the_manual_has_them() {
    let colour = [0x12, 0x34, 0x56, 0x78];
    assert_eq!(PixelFormat::Xrgb8888.encode(colour), 0xFF12_3456);
    assert_eq!(PixelFormat::Argb8888.encode(colour), 0x7812_3456);
    assert_eq!(PixelFormat::Rgb565.encode([0xFF, 0, 0, 0]), 0xF800);
    assert_eq!(PixelFormat::Rgb565.encode([0, 0xFF, 0, 0]), 0x07E0);
    assert_eq!(PixelFormat::Rgb565.encode([0, 0, 0xFF, 0]), 0x001F);
    assert_eq!(PixelFormat::ALL.len(), 3);
    assert_eq!(PixelFormat::ALL[0].bytes(), 4);
    assert_eq!(PixelFormat::ALL[1].bytes(), 4);
    assert_eq!(PixelFormat::ALL[2].bytes(), 2);
}

#[test]
fn pixel_format_decode_then_encode_is_the_stored_pixel() {
    for pixel in 0..=0xFFFF {
        let format = PixelFormat::Rgb565;
        assert_eq!(format.encode(format.decode(pixel)), pixel);
    }
    for pixel in (0..=u32::MAX).step_by(0x0001_0421) {
        let format = PixelFormat::Argb8888;
        assert_eq!(format.encode(format.decode(pixel)), pixel);
        let format = PixelFormat::Xrgb8888;
        assert_eq!(format.encode(format.decode(pixel)), pixel | 0xFF00_0000);
    }
}

#[test]
fn pixel_format_decode_of_black_and_white_is_exact() {
    for &format in PixelFormat::ALL {
        for colour in [[0, 0, 0, 255], [255, 255, 255, 255]] {
            assert_eq!(format.decode(format.encode(colour)), colour, "{}", format.name());
        }
    }
}

#[test]
fn texture_format_bits_and_palettes_are_those_of_the_manual() {
    let found: Vec<_> = TextureFormat::ALL.iter().map(|f| (f.name(), f.bits(), f.palette())).collect();
    let expected = [
        ("rgba8888", 32, 0),
        ("rgb565", 16, 0),
        ("rgba5551", 16, 0),
        ("rgba4444", 16, 0),
        ("palette8", 8, 256),
        ("palette4", 4, 16),
    ];
    assert_eq!(found, expected);
}

#[test]
fn light_record_words_lie_where_the_manual_has_them() {
    let record = LightRecord {
        kind: 2,
        position: [1.0, 2.0, 3.0],
        direction: [4.0, 5.0, 6.0],
        cut_off: 7.0,
        spot_exponent: 8.0,
        colour: 9,
        ambient: 10,
        reserved: [0; 5],
    };
    let words: &[u32] = bytemuck::cast_slice(core::slice::from_ref(&record));
    let numbers = [1.0_f32, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0].map(f32::to_bits);
    assert_eq!(words, [&[2], &numbers[..], &[9, 10, 0, 0, 0, 0, 0]].concat());
    assert_eq!((LIGHT_BYTES, MOST_LIGHTS), (64, 256));
}

#[test]
fn bitmap_formats_of_frame_buffers_are_their_pixel_formats() {
    for &format in PixelFormat::ALL {
        let bitmap = BitmapFormat::from(format);
        assert_eq!((bitmap.code(), bitmap.name()), (format.code(), format.name()));
        assert_eq!((bitmap.pixel_format(), bitmap.bytes()), (Some(format), format.bytes()));
        let colour = [0x12, 0x34, 0x56, 0x78];
        assert_eq!(bitmap.encode(colour), format.encode(colour));
        assert_eq!(bitmap.decode(0x9ABC_DEF0), format.decode(0x9ABC_DEF0));
    }
    assert_eq!(
        BitmapFormat::ALL.iter().map(|format| format.bits()).collect::<Vec<_>>(),
        [0xFFFF_FFFF, 0xFFFF_FFFF, 0xFFFF, 0xFF]
    );
}

#[test]
fn bitmap_format_of_coverage_alone_is_black_with_alpha() {
    let format = BitmapFormat::Alpha8;
    assert_eq!((format.bytes(), format.pixel_format()), (1, None));
    assert_eq!(format.decode(0xFFFF_FF5A), [0, 0, 0, 0x5A]);
    assert_eq!(format.encode([1, 2, 3, 0x5A]), 0x5A);
}

#[test]
fn raster_operations_tell_what_they_read() {
    let which = |reads: fn(RasterOperation) -> bool| -> Vec<u32> {
        RasterOperation::ALL.iter().filter(|&&operation| reads(operation)).map(|operation| operation.code()).collect()
    };
    // All but clear, no-operation, invert, set; all but clear, copy, copy-inverted, set.
    assert_eq!(which(RasterOperation::reads_source), [1, 2, 3, 4, 6, 7, 8, 9, 11, 12, 13, 14]);
    assert_eq!(which(RasterOperation::reads_destination), [1, 2, 4, 5, 6, 7, 8, 9, 10, 11, 13, 14]);
}

#[test]
fn depth_format_all_twelve_round_trip() {
    let codes: Vec<_> = (0..=0x1FFF)
        .filter(|code| code & !0x1F1F == 0)
        .filter(|&code| DepthFormat::from_code(code).is_some())
        .collect();
    assert_eq!(codes.len(), 12);
    for code in codes {
        assert_eq!(DepthFormat::from_code(code).map(DepthFormat::code), Some(code));
    }
    assert_eq!(DepthFormat::default().code(), 0x1818);
}

#[test]
fn depth_format_maximum_is_all_bits_set() {
    let maximum = |bits| DepthFormat::new(bits, 0).map(DepthFormat::maximum);
    assert_eq!(maximum(16), Some(0xFFFF));
    assert_eq!(maximum(24), Some(0x00FF_FFFF));
    assert_eq!(maximum(31), Some(0x7FFF_FFFF));
    assert_eq!(maximum(32), None);
    assert_eq!(DepthFormat::new(24, 4), None);
}

#[test]
fn picture_format_stored_pixels_come_back() {
    for &format in PictureFormat::ALL {
        let bits = u32::MAX >> (32 - 8 * format.bytes());
        for pixel in [0, 0x1234_5678, 0x89AB_CDEF, u32::MAX].map(|pixel| pixel & bits) {
            let argb = format.decode(pixel);
            let unused =
                if matches!(format, PictureFormat::Xrgb8888 | PictureFormat::Xbgr8888) { 0xFF00_0000 } else { 0 };
            assert_eq!(format.encode(argb), pixel | unused, "{} {pixel:#x}", format.name());
        }
    }
    assert_eq!(PictureFormat::Abgr8888.decode(0x1122_3344), 0x1144_3322);
    assert_eq!(PictureFormat::Alpha8.decode(0x7F), 0x7F00_0000);
    assert_eq!(PictureFormat::Rgb565.decode(0xF800), 0xFFFF_0000);
}
