//! The solvers across all experiments.

use crate::across::{Across, COUNTED, MAP, NAME, READS, TITLE, Table};
use crate::escape::html;
use crate::plot::inline;
use crate::prose;

/// Writes the section.
pub(super) fn write(out: &mut String, across: &Across) {
    put!(out, "<section>\n<h2 id=\"solvers\">{TITLE}</h2>\n");
    for text in &across.text {
        put!(out, "<p>{}</p>\n", prose::html(text));
    }
    put!(out, "<details><summary>{COUNTED}</summary>\n");
    for text in &across.counted {
        put!(out, "<p>{}</p>\n", prose::html(text));
    }
    out.push_str("</details>\n");
    put!(
        out,
        "<figure id=\"solvers-map\" class=\"wide\" aria-labelledby=\"solvers-map-caption\">\
         <div class=\"panels\" role=\"region\" tabindex=\"0\" aria-label=\"{MAP}\">\n"
    );
    for (n, panel) in across.map.panels.iter().enumerate() {
        out.push_str(&inline(panel, &format!("solvers-map-{n}"), MAP));
    }
    put!(
        out,
        "</div>\n<figcaption><b id=\"solvers-map-caption\">{MAP}</b> {} \
         <small><a href=\"{NAME}.svg\">SVG</a> · <a href=\"{NAME}.csv\">data</a></small></figcaption></figure>\n",
        prose::html(READS)
    );
    for table in &across.tables {
        write_table(out, table);
    }
    out.push_str("</section>\n");
}

fn write_table(out: &mut String, Table { title, reads, grid, folded }: &Table) {
    let (name, grid) = (html(title), grid.html(title));
    let reads = prose::html(reads);
    if *folded {
        put!(out, "<details><summary>{name}</summary>\n<p>{reads}</p>\n{grid}</details>\n");
    } else {
        put!(out, "<h3>{name}</h3>\n<p>{reads}</p>\n{grid}");
    }
}
