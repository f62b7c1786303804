//! `report`: tests: every evaluation has its report, and writing it again gives the same.

use std::fs;

use super::common::{refused, scratch, stdout_of, text};

#[test]
fn an_evaluation_has_a_report_with_maps_plots_and_every_parameter() {
    let out = scratch("report");
    let asked = ["evaluate", "--trials", "2", "--scenario", "3", "--maps", "1", "--out", text(&out)];
    stdout_of(&[&asked[..], PNG].concat());
    let page = fs::read_to_string(out.join("report.html")).expect("a report");
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>"));
    for part in
        ["id=\"table-1\"", "id=\"table-6\"", "the first 1 trials of each", "free_path", "grab.success"]
    {
        assert!(page.contains(part), "{part}");
    }
    for picture in ["table-1-outcomes", "differences", "maps-dg-3"] {
        let svg = fs::read_to_string(out.join(format!("plots/{picture}.svg"))).expect(picture);
        assert!(svg.starts_with("<svg") && page.contains("<svg"));
        if cfg!(feature = "png") {
            let png = fs::read(out.join(format!("plots/{picture}.png"))).expect(picture);
            assert!(png.starts_with(b"\x89PNG"), "{picture}");
        }
    }

    fs::remove_file(out.join("report.html")).expect("it was there");
    let again = stdout_of(&["evaluate", "report", text(&out), "--maps", "1"]);
    assert_eq!(again.trim(), out.join("report.html").display().to_string());
    assert_eq!(fs::read_to_string(out.join("report.html")).expect("a report"), page);

    let merged = out.join("merged");
    stdout_of(&["evaluate", "merge", text(&out), "--maps", "1", "--out", text(&merged)]);
    assert_eq!(fs::read_to_string(merged.join("report.html")).expect("a report"), page);
}

#[test]
fn figures_go_between_the_markers_of_a_document() {
    let out = scratch("markdown");
    let asked = ["evaluate", "--trials", "2", "--opponents", "2d", "--maps", "0", "--out", text(&out)];
    stdout_of(&asked);
    let document = out.join("figures.md");
    let again = ["evaluate", "report", text(&out), "--maps", "0", "--markdown", text(&document)];
    assert!(refused(&again, 1).contains("figures.md"), "there is no such file");
    fs::write(&document, "words\n").expect("a file");
    assert!(refused(&again, 1).contains("there is no line `<!-- figures"));
    fs::write(
        &document,
        "before\n<!-- figures: written by `cargo xtask evaluation` -->\nold\n<!-- end of figures -->\nafter\n",
    )
    .expect("a file");
    stdout_of(&again);
    let written = fs::read_to_string(&document).expect("a file");
    assert!(
        written.starts_with("before\n") && written.ends_with("\nafter\n") && !written.contains("\nold\n")
    );
    assert!(written.contains("### Table 4") && !written.contains("### Table 1"));
    let pictures: Vec<_> =
        written.split("](figures/").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert!(!pictures.is_empty());
    for picture in pictures {
        assert!(out.join("figures").join(picture).is_file(), "{picture}");
    }
}

#[test]
fn a_report_of_nothing_is_refused() {
    let out = scratch("nothing");
    assert!(refused(&["evaluate", "report", text(&out)], 1).contains("no trials there"));
}

#[test]
fn an_ablation_has_its_page_and_its_table_in_a_document() {
    let out = scratch("ablation-page");
    let document = out.join("worth.md");
    fs::write(
        &document,
        "<!-- ablations: written by `cargo xtask evaluation` -->\n<!-- end of ablations -->\n",
    )
    .expect("a file");
    let asked = ["evaluate", "ablations", "--arm", "no-opponents", "--trials", "1"];
    stdout_of(&[&asked[..], PNG, &["--out", text(&out), "--markdown", text(&document)]].concat());
    let page = fs::read_to_string(out.join("report.html")).expect("a page");
    assert!(
        page.contains("--no-opponents") && page.contains("In every cell") && page.contains("grab.success")
    );
    if cfg!(feature = "png") {
        assert!(fs::read(out.join("plots/ablations.png")).expect("a plot").starts_with(b"\x89PNG"));
    }
    let written = fs::read_to_string(&document).expect("a file");
    assert!(written.contains("| no-opponents |") && written.contains("](worth/ablations.svg)"), "{written}");
    assert!(out.join("worth/ablations.svg").is_file());
}

/// Plots as PNG too, where the program draws them.
const PNG: &[&str] = if cfg!(feature = "png") { &["--png"] } else { &[] };

#[cfg(not(feature = "png"))]
#[test]
fn a_program_without_png_says_how_to_get_one_with_it() {
    let out = scratch("without-png");
    let refused = refused(&["evaluate", "--trials", "1", "--png", "--out", text(&out)], 2);
    assert!(refused.contains("cargo build --release --features png"), "{refused}");
}
