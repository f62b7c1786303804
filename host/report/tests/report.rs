//! `report`: tests: the page contains everything that was measured, and nothing else. The paper's rows stand
//! in for ours, a little changed.

use arena::TrialConfig;
use brain::Approach;
use hil_sim::{Configuration, Scenario};
use report::{Facts, Map, Report, SQUARE_MM};
use study::evaluation::{
    Claim, ClaimVerdict, Comparison, Held, Judgement, JudgementLine, TableRow, compare, paper, with_paper,
};

/// Rows that could be ours: the paper's, some of them changed.
fn ours() -> Vec<TableRow> {
    let mut rows = paper().to_vec();
    for row in rows.iter_mut().filter(|row| row.table == 1 && row.approach == Approach::Cases) {
        // 51 of 500, and 10.2 − 8 points fewer.
        row.close = Some(10.2);
        row.time_sd = Some(9.5);
    }
    rows
}

struct Made {
    rows: Vec<TableRow>,
    with_paper: Vec<Comparison>,
    between: Vec<Comparison>,
    papers: Vec<Comparison>,
    claims: Vec<Claim>,
    lines: Vec<JudgementLine>,
    facts: Vec<Facts>,
    maps: Vec<Map>,
}

impl Made {
    fn new() -> Self {
        let rows = ours();
        let (cbr, reactive) = (Approach::Cases, Approach::Reactive);
        let judged = |verdict, evidence: &str| Judgement {
            verdict,
            evidence: evidence.to_owned(),
            points: Vec::new(),
        };
        Self {
            with_paper: with_paper(&rows, paper()),
            between: compare(&rows, cbr, reactive),
            papers: compare(paper(), cbr, reactive),
            rows,
            claims: vec![Claim {
                id: "a<b",
                section: "5.2.1",
                sentence: "<script>alert('&')</script>",
                ours_as_paper: None,
                ours: judged(ClaimVerdict::Supported, "34 > 28 | 31 & *so*"),
                paper: judged(ClaimVerdict::Undecided, "p = 0.31"),
            }],
            lines: vec![JudgementLine {
                id: "z",
                line: "more < less",
                verdict: Held::Missed,
                evidence: "3 < 4".to_owned(),
            }],
            facts: vec![Facts {
                title: "Program & options".to_owned(),
                entries: vec![
                    ("seed".to_owned(), "7".to_owned()),
                    ("--set".to_owned(), "cost=\"sum\" <default>".to_owned()),
                ],
            }],
            maps: Vec::new(),
        }
    }

    fn report(&self) -> Report<'_> {
        Report {
            rows: &self.rows,
            paper: paper(),
            with_paper: &self.with_paper,
            between: &self.between,
            papers_between: &self.papers,
            uses: &[],
            claims: &self.claims,
            lines: &self.lines,
            facts: &self.facts,
            maps: &self.maps,
        }
    }
}

/// The text of the page, without its tags.
fn cells(html: &str) -> Vec<String> {
    html.split('<').filter_map(|part| part.split_once('>')).map(|(_, text)| text.trim().to_owned()).collect()
}

/// The part of the page between an element with this id and the end of its section.
fn section<'h>(html: &'h str, id: &str) -> &'h str {
    let begin = html.find(&format!("id=\"{id}\"")).unwrap_or_else(|| panic!("no #{id}"));
    &html[begin..begin + html[begin..].find("</section>").unwrap()]
}

#[test]
fn the_page_has_every_table_with_its_plots() {
    let made = Made::new();
    let html = made.report().html();
    let tag = |name: &str| html.matches(&format!("<{name}")).count();
    let heads =
        html.match_indices("<h2>").map(|(at, _)| &html[at + 4..at + 4 + html[at + 4..].find('<').unwrap()]);
    let heads: Vec<_> = heads.map(|head| head.split(':').next().unwrap()).collect();
    let tables: Vec<_> = (1..=6).map(|number| format!("Table {number}")).collect();
    let mut expected = vec![
        "At a glance",
        "What the paper says, and what the numbers say",
        "The pattern of its results, and what is asked of ours",
    ];
    expected.extend(tables.iter().map(String::as_str));
    expected.extend(["Every comparison", "What decided the trials"]);
    assert_eq!(heads, expected);
    // At a glance; outcomes and means of Tables 1 and 6; 2; 3; 4; 5.
    assert_eq!(tag("figure"), 1 + 2 + 1 + 1 + 1 + 1 + 2);
    assert_eq!(tag("svg"), html.matches("</svg>").count());
    // Every link has a target.
    for link in html.split("href=\"#").skip(1).map(|rest| rest.split('"').next().unwrap()) {
        assert!(html.contains(&format!("id=\"{link}\"")), "#{link}");
    }
}

#[test]
fn the_page_stands_alone() {
    let made = Made::new();
    let html = made.report().html().replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
    for outside in ["http:", "https:", "<script", "<link", "<img", "url(", "@import", "<iframe"] {
        assert!(!html.contains(outside), "{outside}");
    }
}

#[test]
fn text_from_outside_cannot_break_the_page() {
    let html = Made::new().report().html();
    assert!(html.contains("&lt;script&gt;alert('&amp;')&lt;/script&gt;"));
    assert!(html.contains("more &lt; less") && html.contains("Program &amp; options"));
    assert!(html.contains("cost=&quot;sum&quot; &lt;default&gt;"));
}

#[test]
fn every_share_of_ours_and_the_papers_is_in_its_table() {
    let made = Made::new();
    let html = made.report().html();
    let mut checked = 0;
    for (rows, ours) in [(made.rows.as_slice(), true), (paper(), false)] {
        for row in rows {
            let cells = cells(section(&html, &format!("table-{}", row.table)));
            let shares = [row.goal, row.close, row.block, row.out, row.to_goal];
            for value in shares.into_iter().flatten() {
                let whole = !ours && value.fract().abs() < 1e-9;
                let text = if whole { format!("{value:.0}") } else { format!("{value:.1}") };
                assert!(cells.contains(&text), "{text} of {row:?}");
                checked += 1;
            }
            for value in [row.possession_mean, row.possession2_mean, row.time_mean].into_iter().flatten() {
                // Table 6 prints no times.
                if !(row.table == 6 && row.time_mean == Some(value)) {
                    assert!(cells.contains(&format!("{value:.2}")), "{value} of {row:?}");
                    checked += 1;
                }
            }
            for value in [row.backups_a, row.backups_b, row.individual, row.cooperative].into_iter().flatten()
            {
                assert!(cells.contains(&format!("{value:.1}")), "{value} of {row:?}");
                checked += 1;
            }
        }
    }
    // 8 rows of 5 + 2, 8 of 2, 8 of 3, 4 of 5 + 1, 8 of 2; ours and the paper's.
    assert_eq!(checked, 2 * (8 * 7 + 8 * 2 + 8 * 3 + 4 * 6 + 8 * 2));
}

#[test]
fn intervals_and_p_are_those_of_a_hand_calculation() {
    let made = Made::new();
    let html = made.report().html();
    let table = section(&html, "table-1");
    let block = &table[table.find("1 · middle-back").unwrap()..table.find("2 · left side").unwrap()];
    let cells = cells(block);
    // Wilson of 170 of 500: centre (0.34 + 3.8415 / 1000) / 1.0076829 = 0.34122, reach 0.04140.
    assert!(cells.contains(&"30.0–38.3".to_owned()), "{cells:?}");
    // 51 against 45 of 500: +1.2; pooled 0.096, z = 0.006 × 2 / 0.018632 = 0.644, p = 0.52, four such
    // scenarios: 1.
    assert!(cells.contains(&"+1.2".to_owned()), "{cells:?}");
    // Out, the paper's 28 less 37: −9.0; z = −3.04, p = 0.0024, the greatest of four: as it is, two stars.
    assert!(cells.contains(&"−9.0".to_owned()) && cells.contains(&"p = 0.002".to_owned()), "{cells:?}");
    assert!(block.contains("−9.0<sup>**</sup>"), "{block}");
    assert!(cells.contains(&"sd 9.50".to_owned()) && cells.contains(&"sd 1.37".to_owned()));
}

#[test]
fn rows_of_the_paper_have_a_style_of_their_own() {
    let html = Made::new().report().html();
    let paper = html.matches("<tr class=\"paper\" style").count();
    assert_eq!(paper, html.matches("<tr class=\"ours\" style").count());
    assert!(paper == paper_rows() && html.contains("tr.paper td"));
}

fn paper_rows() -> usize {
    paper().len()
}

#[test]
fn plots_are_whole_svgs_and_carry_their_numbers() {
    let made = Made::new();
    let files = made.report().figure_files();
    let names: Vec<_> = files.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "differences",
            "table-1-outcomes",
            "table-1-means",
            "table-2-backing-up",
            "table-3-cases",
            "table-4-outcomes",
            "table-5-means",
            "table-6-outcomes",
            "table-6-means"
        ]
    );
    for file in &files {
        let document = roxmltree::Document::parse(&file.svg).unwrap();
        let (_, _, width, height) = view_box(&document);
        for node in document.descendants().filter(|node| node.has_tag_name("circle")) {
            assert!(node.attribute("r").is_some_and(|r| r.parse::<f64>().unwrap() > 0.0));
        }
        assert!(width > 300.0 && height > 100.0, "{} {width} {height}", file.name);
    }
    let texts = |name: &str| -> Vec<String> {
        let svg = &files.iter().find(|file| file.name == name).unwrap().svg;
        let document = roxmltree::Document::parse(svg).unwrap();
        let texts = document.descendants().filter(|node| node.has_tag_name("text"));
        texts.filter_map(|node| node.text().map(str::to_owned)).collect()
    };
    // Scenario 4, case-based less reactive: 44 − 26 to goal, 11 − 25 out.
    let differences = texts("differences");
    assert!(differences.contains(&"+18.0".to_owned()) && differences.contains(&"−14.0".to_owned()));
    assert!(texts("table-2-backing-up").contains(&"26.2".to_owned()));
    assert!(texts("table-5-means").contains(&"3.59".to_owned()));
}

fn view_box(document: &roxmltree::Document<'_>) -> (f64, f64, f64, f64) {
    let text = document.root_element().attribute("viewBox").unwrap();
    let numbers: Vec<f64> = text.split(' ').map(|number| number.parse().unwrap()).collect();
    (numbers[0], numbers[1], numbers[2], numbers[3])
}

#[test]
fn maps_are_drawn_with_what_they_count() {
    let config = TrialConfig::new(Scenario::DefenderAhead, Configuration::DefenderGoalie, Approach::Cases, 5);
    let cell = study::evaluation::EvaluationCell {
        profile: arena::Profile::Simulated,
        configuration: config.opponents,
        scenario: config.scenario,
        approach: config.approach,
        trials: 1,
    };
    let map = Map::play(cell, config.base.field(), &[config]).unwrap();
    let mut made = Made::new();
    made.maps.push(map.clone());
    let html = made.report().html();
    assert!(section(&html, "maps").contains("the first 1 trials of each"));
    let sheet = made.report().figure_files().pop().unwrap();
    assert_eq!(sheet.name, "maps-dg-3");
    roxmltree::Document::parse(&sheet.svg).unwrap();
    // Squares where the ball was for at least 5 ms of the one trial: of every tick of 40 ms.
    let squares = map.seconds.iter().filter(|seconds| **seconds > 0.0).count();
    assert_eq!(sheet.svg.matches(&format!("h{SQUARE_MM:.0}v{SQUARE_MM:.0}")).count(), squares);
    assert_eq!(map.ends.len(), 1);
}

#[test]
fn markdown_has_the_numbers_and_rows_of_equal_width() {
    let text = Made::new().report().markdown("pictures/");
    assert!(text.starts_with("Played by seed 7.\n"), "{text}");
    assert!(text.contains("### Table 1") && text.contains("](pictures/table-1-outcomes.svg)"));
    // Ours, the paper's in italics; the difference with its stars.
    assert!(text.contains("| 10.2 *9* |"), "{text}");
    assert!(text.contains("−19.0\\*\\*\\* *−19.0\\*\\*\\**"), "{text}");
    assert!(text.contains("34 > 28 \\| 31 & \\*so\\*"), "{text}");
    assert!(text.contains("| z | more < less | **missed** | 3 < 4 |"), "{text}");
    let mut columns = None;
    for line in text.lines() {
        let bars = line.replace("\\|", "").matches('|').count();
        if bars > 0 {
            assert_eq!(*columns.get_or_insert(bars), bars, "{line}");
        } else {
            columns = None;
        }
    }
}

#[test]
fn the_same_results_are_the_same_page() {
    assert_eq!(Made::new().report().html(), Made::new().report().html());
    let nothing = Report {
        rows: &[],
        paper: paper(),
        with_paper: &[],
        between: &[],
        papers_between: &[],
        uses: &[],
        claims: &[],
        lines: &[],
        facts: &[],
        maps: &[],
    };
    assert!(nothing.html().contains("At a glance") && nothing.figure_files().is_empty());
}
