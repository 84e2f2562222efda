//! The 5 x 5 matrices of shafts in answers.

use serde_json::Value;

/// A matrix in a file of answers.
#[track_caller]
pub fn matrix(json: &Value) -> [[f64; 5]; 5] {
    assert!(json.is_array(), "{json}");
    std::array::from_fn(|i| std::array::from_fn(|j| json[i][j].as_f64().unwrap()))
}

/// Every entry to a share of the largest of its kind.
#[track_caller]
pub fn assert_same_matrix(what: &str, found: [[f64; 5]; 5], expected: [[f64; 5]; 5], limit: f64) {
    let arm = |i: usize| if i < 3 { 1.0 } else { 0.03 };
    let scaled = |m: &[[f64; 5]; 5], i: usize, j: usize| m[i][j] / (arm(i) * arm(j));
    let all = (0..25).map(|k| (k / 5, k % 5));
    let largest = all
        .clone()
        .fold(0.0f64, |most, (i, j)| most.max(scaled(&expected, i, j).abs()));
    for (i, j) in all {
        let error = (scaled(&found, i, j) - scaled(&expected, i, j)).abs() / largest;
        assert!(error < limit, "{what} {i} {j}: {error:e}");
    }
}
