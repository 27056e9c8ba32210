//! Every hard case of the manual, chapter "Numbers", as a test `hard::<unit>::<name>`. `--nocapture` prints the rows.

use zga_tests::hard::{CASES, Row};

fn check(number: u32, name: &str, row: &Row) {
    println!("{row}");
    assert_eq!((row.case, row.name), (number, name), "the row is another's");
    assert!(row.passed, "{row}");
}

/// A module for each unit, a test for each case.
macro_rules! tests {
    ($($unit:ident { $($number:literal $name:ident;)+ })+) => {
        mod hard {
            $(mod $unit {
                $(
                    #[test]
                    fn $name() {
                        let name = concat!(stringify!($unit), "::", stringify!($name));
                        crate::check($number, name, &zga_tests::hard::$unit::$name());
                    }
                )+
            })+
        }
    };
}

zga_tests::hard_cases!(tests);

#[test]
fn cases_have_the_numbers_of_the_manual_and_each_once() {
    let numbers: Vec<u32> = CASES.iter().map(|case| case.number).collect();

    assert_eq!(numbers, (1..=60).collect::<Vec<u32>>());
}
