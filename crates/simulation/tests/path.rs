//! A path is exact at its nodes, of known order between them, and knows where it turns.

use simulation::Path;

/// q = sin t with one more state, cos 2t, over nodes `h` apart.
fn sine(h: f64, count: u32) -> Path {
    let mut path = Path::new(3);
    for k in 0..=count {
        let t = h * f64::from(k);
        let y = [t.sin(), t.cos(), (2.0 * t).cos()];
        path.push(t, &y, &[t.cos(), -t.sin(), -2.0 * (2.0 * t).sin()]);
    }
    path
}

fn worst(path: &Path, error: impl Fn(f64) -> f64) -> f64 {
    let end = path.end().expect("a path with nodes").0;
    (0..=997).map(|k| error(end * f64::from(k) / 997.0).abs()).fold(0.0, f64::max)
}

#[test]
fn displacement_is_of_sixth_order_and_the_rest_of_fourth() {
    let errors = [(0.2, 20), (0.1, 40)].map(|(h, count)| {
        let path = sine(h, count);
        let x = worst(&path, |t| {
            let mut y = [0.0; 3];
            path.state(t, &mut y);
            y[2] - (2.0 * t).cos()
        });
        [
            worst(&path, |t| path.q(t) - t.sin()),
            worst(&path, |t| path.v(t) - t.cos()),
            x,
            worst(&path, |t| path.v_dot(t) + t.sin()),
        ]
    });
    for (i, order) in [6.0, 4.0, 4.0, 3.0].into_iter().enumerate() {
        let slope = (errors[0][i] / errors[1][i]).log2();
        assert!((slope - order).abs() < 0.2, "column {i}: order {slope:.2}, expected {order}");
    }
    assert!(errors[1][0] < 1e-6 / 46080.0 * 1.1, "q is off by {:e} m", errors[1][0]);
}

#[test]
fn at_its_nodes_a_path_is_what_was_pushed() {
    let path = sine(0.3, 10);
    for (i, t) in path.t().iter().enumerate() {
        let mut y = [0.0; 3];
        path.state(*t, &mut y);
        assert_eq!(y, path.node(i), "at {t} s");
        assert_eq!(path.v_dot(*t), path.node_dot(i)[1]);
    }
    assert_eq!(path.q(-1.0), 0.0, "before the first node it is the first");
    assert_eq!(path.q(9.0), path.end().unwrap().1[0], "after the last it is the last");
}

#[test]
fn a_path_turns_where_the_cosine_is_zero() {
    let turns = sine(0.01, 1000).reversals();
    let expected = [0.5, 1.5, 2.5].map(|k| k * std::f64::consts::PI);
    assert_eq!(turns.len(), 3);
    for (turn, expected) in turns.iter().zip(expected) {
        assert!((turn - expected).abs() < 1e-10, "{turn} s, not {expected} s");
    }
}

#[test]
fn a_kink_is_kept_and_a_node_at_rest_is_one_reversal() {
    // v rises from −1 to 0 at t = 1, twice there, and on at another slope.
    let mut path = Path::new(2);
    path.push(0.0, &[0.0, -1.0], &[-1.0, 1.0]);
    path.push(1.0, &[-0.5, 0.0], &[0.0, 1.0]);
    path.push(1.0, &[-0.5, 0.0], &[0.0, 3.0]);
    path.push(2.0, &[1.0, 3.0], &[3.0, 3.0]);
    assert_eq!(path.reversals(), [1.0]);
    for (t, q, v, v_dot) in
        [(0.5, -0.375, -0.5, 1.0), (1.5, -0.125, 1.5, 3.0), (1.0, -0.5, 0.0, 3.0)]
    {
        assert!((path.q(t) - q).abs() < 1e-15, "q({t} s) = {} m, not {q} m", path.q(t));
        assert!((path.v(t) - v).abs() < 1e-15, "v({t} s) = {} m/s, not {v} m/s", path.v(t));
        assert!((path.v_dot(t) - v_dot).abs() < 1e-14, "v_dot({t} s) = {} m/s²", path.v_dot(t));
    }
}

#[test]
fn starting_from_rest_and_touching_it_are_no_reversals() {
    let mut path = Path::new(2);
    for (t, v) in
        [(0.0, 0.0), (1.0, 0.0), (2.0, 1.0), (3.0, 0.0), (4.0, 1.0), (5.0, -1.0), (6.0, 0.0)]
    {
        path.push(t, &[0.0, v], &[v, 0.0]);
    }
    assert_eq!(path.reversals(), [4.5]);
}

#[test]
fn onsets_are_where_the_speed_rises_through_a_threshold() {
    // |cos t| = 1/2 at π/3 falling, 2π/3 rising, 4π/3 falling and 5π/3 rising.
    let onsets = sine(0.01, 620).onsets(0.5);
    let expected = [2.0, 5.0].map(|k| k * std::f64::consts::PI / 3.0);
    assert_eq!(onsets.len(), 2);
    for (onset, expected) in onsets.iter().zip(expected) {
        assert!((onset - expected).abs() < 1e-10, "{onset} s, not {expected} s");
    }
}

#[test]
fn the_largest_value_lies_between_the_nodes() {
    let path = sine(0.1, 60);
    let (t, q) = path.largest((0.0, 6.0), |t| path.q(t)).unwrap();
    assert!(
        (t - std::f64::consts::FRAC_PI_2).abs() < 1e-4 && (q - 1.0).abs() < 1e-9,
        "{q} m at {t} s"
    );
    let (t, q) = path.largest((2.0, 4.0), |t| path.q(t)).unwrap();
    assert!(t == 2.0 && q == path.q(2.0), "at the edge of the span, not {t} s");
    assert_eq!(path.largest((7.0, 8.0), |t| path.q(t)), None);
}
