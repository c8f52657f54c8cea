use identify::{
    Recording, Rig,
    fit::{Data, Options, fit},
};
use std::collections::BTreeMap;
fn columns(name: &str) -> BTreeMap<String, Vec<f64>> {
    let mut r = csv::Reader::from_path(name).unwrap();
    let h: Vec<String> = r.headers().unwrap().iter().map(str::to_owned).collect();
    let mut c = vec![vec![]; h.len()];
    for row in r.records() {
        for (i, f) in row.unwrap().iter().enumerate() {
            c[i].push(f.parse().unwrap());
        }
    }
    h.into_iter().zip(c).collect()
}
#[test]
fn emps() {
    let rig = Rig::parse(&std::fs::read_to_string(std::env::var("RIG").unwrap()).unwrap()).unwrap();
    let c = columns(&std::env::var("REC").unwrap());
    let rec =
        Recording::new(&rig, &|n| c.get(n).map(Vec::as_slice).ok_or_else(|| n.to_owned())).unwrap();
    let data = Data::of(&rig, &rec);
    let t = std::time::Instant::now();
    for closed in [true] {
        let mut rig = rig.clone();
        if !closed {
            rig.controller = None;
        }
        let fit = fit(
            &rig,
            &data,
            &Options {
                models: false,
                profiles: true,
                window: std::env::var("W").ok().map(|w| w.parse().unwrap()),
                ..Options::default()
            },
        )
        .unwrap();
        println!(
            "{:?} {:?} {} {:?} {:?} s2 {} nb {} step {}",
            t.elapsed(),
            fit.way,
            fit.windows,
            fit.end,
            fit.simulations,
            fit.variance,
            fit.neighbours,
            fit.step_error
        );
        for p in &fit.parameters {
            println!(
                "{:8} {:.5} -> {:.5} +- {:.5} {:?} boot {:?}",
                p.name, p.given, p.found, p.standard_error, p.interval, p.bootstrap
            );
        }
        for g in &fit.gap {
            println!("{g:?}");
        }
        for m in &fit.models {
            println!("{} {} {} {}", m.name, m.free, m.trained_error, m.held_out_error);
        }
    }
}
#[test]
fn look() {
    let mut rig =
        Rig::parse(&std::fs::read_to_string(std::env::var("RIG").unwrap()).unwrap()).unwrap();
    for (n, v) in [
        ("f_c", 0.58),
        ("f_s", 0.94),
        ("v_s", 0.0012),
        ("sigma_0", 920.0),
        ("sigma_1", 28.0),
        ("sigma_2", 1.25),
        ("k_1", 0.62),
        ("k_2", 0.5),
        ("f_10", 0.0026),
        ("f_20", 0.0191),
        ("offset", -0.528),
    ] {
        rig.set(n, v).unwrap();
    }
    let c = columns(&std::env::var("REC").unwrap());
    let rec =
        Recording::new(&rig, &|n| c.get(n).map(Vec::as_slice).ok_or_else(|| n.to_owned())).unwrap();
    let data = Data::of(&rig, &rec);
    for w in [None, Some(3.0)] {
        let s = identify::fit::simulate(&rig, &data, w).unwrap();
        for g in &s.gap {
            println!("{w:?} {} {:.3e} {:.3e}", g.channel, g.after, g.noise);
        }
        let t = &s.traces[0];
        let mut line = String::new();
        for k in 0..50 {
            let r: Vec<f64> =
                (k * 100..(k + 1) * 100).map(|i| t.after[i] - t.measured[i]).collect();
            line += &format!(
                "{:.0}/{:.0} ",
                1e6 * r.iter().sum::<f64>() / 100.0,
                1e6 * (r.iter().map(|x| x * x).sum::<f64>() / 100.0).sqrt()
            );
        }
        println!("{line}");
    }
}
