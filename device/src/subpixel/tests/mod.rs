//! Tests of the sub-pixel mask unit.
//!
//! | file | what is tested |
//! | --- | --- |
//! | `grid` | samples, bits and places against the manual's numbers |
//! | `hide` | what chunks that one piece covers from top to bottom of a band leave to be done |
//! | `scene` | what a scene takes, and by which rule its opaque fragments are ordered |
//! | `search` | bands, ends and steps against the definition; start corners; where the search is exact, and where not |
//! | `search_clocked` | registers and clocks against the functional search |

mod grid;
mod hide;
mod scene;
mod search;
mod search_clocked;
