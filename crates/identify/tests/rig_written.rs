//! A rig written is read as the same rig, whatever the rig.

use duhem::{MODELS, Parameters};
use identify::rig::{KINDS, Kind, Quantity};
use identify::{Channel, Controller, Friction, Hold, Rig, Shaft};
use proptest::prelude::*;
use std::collections::BTreeMap;

/// The example of the design.
const GEARBOX: &str = include_str!("rigs/gearbox.toml");

fn number(positive: bool) -> impl Strategy<Value = f64> {
    let size =
        prop_oneof![1e-9..1e9_f64, Just(1.0), (-59.0..59.0_f64).prop_map(|e| 10.0_f64.powf(e))];
    (size, any::<bool>()).prop_map(move |(v, up)| if positive || up { v } else { -v })
}

fn model() -> impl Strategy<Value = Friction> {
    let scalars = proptest::collection::vec(number(true), 8);
    (0..=MODELS.len(), 1..5_usize, scalars, number(true)).prop_map(|(i, n, values, sigma_2)| {
        let Some(entry) = MODELS.get(i) else {
            let name = "none".to_owned();
            return Friction { name, parameters: Parameters::default(), sigma_2 };
        };
        let list: Vec<f64> = values.iter().copied().cycle().take(n).collect();
        let flat: Parameters = entry.keys.iter().zip(&values).map(|(k, v)| (*k, *v)).collect();
        let lists: Parameters = entry.keys.iter().map(|k| (*k, list.clone())).collect();
        let parameters = if (entry.build)(&flat).is_ok() { flat } else { lists };
        let own = entry.keys.contains(&"sigma_2");
        let sigma_2 = if own { 0.0 } else { sigma_2 };
        Friction { name: entry.name.to_owned(), parameters, sigma_2 }
    })
}

fn channel(kind: &'static Kind, quantity: &'static Quantity) -> impl Strategy<Value = Channel> {
    let units = identify::rig::units::UNITS;
    let fits = units.iter().filter(|u| quantity.dimensions.contains(&u.dimension));
    let names: Vec<String> =
        fits.flat_map(|u| [u.name.to_owned(), format!("-{}", u.name)]).collect();
    let moves = quantity.name == kind.displacement || Some(quantity.name) == kind.velocity;
    let motor = moves && kind.geared();
    (
        "\\PC{0,12}[\"'\\\\\n\t]?",
        proptest::option::of(proptest::sample::select(names)),
        proptest::option::of(number(true)),
        any::<(bool, Option<bool>)>(),
    )
        .prop_map(move |(column, unit, quantum, (at, hold))| Channel {
            column: format!("{}{column}", quantity.name),
            unit,
            quantum,
            at: if at && motor { Shaft::Motor } else { Shaft::Drum },
            hold: hold.map(|held| if held { Hold::ZeroOrder } else { Hold::Linear }),
        })
}

fn channels(kind: &'static Kind) -> impl Strategy<Value = BTreeMap<String, Channel>> {
    let all: Vec<_> = kind.channels.iter().map(|q| (any::<bool>(), channel(kind, q))).collect();
    (all, any::<proptest::sample::Index>()).prop_map(move |(all, drive)| {
        let drive = kind.drives[drive.index(kind.drives.len())];
        let named = kind.channels.iter().zip(all);
        named
            .filter(|(q, (taken, _))| {
                let other = kind.drives.contains(&q.name) && q.name != drive;
                q.name == drive || q.required || *taken && !other
            })
            .map(|(q, (_, channel))| (q.name.to_owned(), channel))
            .collect()
    })
}

fn any_rig() -> impl Strategy<Value = Rig> {
    let kind = proptest::sample::select(KINDS.iter().collect::<Vec<_>>());
    kind.prop_flat_map(|kind| {
        let numbers = proptest::collection::vec(number(false), kind.keys.len());
        let gains = proptest::collection::vec(number(true), 4);
        let title = "\\PC{0,20}[\"'\\\\\n\u{7f}]?";
        let flags = any::<(bool, u64)>();
        (title, numbers, model(), channels(kind), gains, flags).prop_map(
            move |(title, numbers, friction, channels, gains, (controlled, mask))| {
                let keys = kind.keys.iter().zip(numbers);
                let voltage = channels.contains_key("voltage");
                let plant = keys
                    .filter(|(k, _)| k.key != "gain" || voltage)
                    .map(|(k, v)| (k.key.to_owned(), if k.key == "offset" { v } else { v.abs() }))
                    .collect();
                let controller = Controller {
                    kind: "pd".to_owned(),
                    kp: gains[0],
                    kv: gains[1],
                    limit: gains[2],
                    sample_time: gains[3],
                    hold: Hold::Linear,
                };
                let controlled = controlled && channels.contains_key("reference");
                let mut rig = Rig {
                    title,
                    kind: kind.name,
                    plant,
                    friction,
                    free: Vec::new(),
                    channels,
                    controller: controlled.then_some(controller),
                    effects: Vec::new(),
                };
                let names = rig.parameters().into_iter().enumerate();
                rig.free =
                    names.filter(|(i, _)| mask >> (i % 64) & 1 == 1).map(|(_, n)| n).collect();
                rig
            },
        )
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn a_rig_written_is_read_as_the_same_rig(rig in any_rig()) {
        let text = rig.write();
        prop_assert_eq!(Rig::parse(&text), Ok(rig), "{}", text);
    }

    #[test]
    fn a_damaged_rig_file_is_read_or_refused_and_never_more(
        cut in any::<proptest::sample::Index>(), put in "\\PC{0,3}|[\\[\\]{}=\"\\.\n]{1,4}", drop in 0..9_usize,
    ) {
        let letters: Vec<char> = GEARBOX.chars().collect();
        let at = cut.index(letters.len());
        let rest = &letters[(at + drop).min(letters.len())..];
        let text: String = letters[..at].iter().copied().chain(put.chars()).chain(rest.iter().copied()).collect();
        if let Ok(rig) = Rig::parse(&text) {
            prop_assert_eq!(Rig::parse(&rig.write()), Ok(rig));
        }
    }
}
