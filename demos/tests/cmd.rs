//! What the program says: the transcripts in `cmd`.

#[test]
fn transcripts_are_as_written() {
    // Help is as wide as the terminal; here it is 100 columns.
    trycmd::TestCases::new().env("COLUMNS", "100").case("tests/cmd/*.trycmd");
}
