//! Fewer points for the same picture: of each column of pixels the first, lowest, highest and last.

/// Thins a line of pixels, `[n][2]`; the order is kept. Short lines are returned as they are.
pub fn thin(line: &[[i32; 2]], column: i32) -> Vec<[i32; 2]> {
    if line.len() < 500 {
        return line.to_vec();
    }
    let mut out: Vec<[i32; 2]> = Vec::new();
    for run in line.chunk_by(|a, b| a[0].div_euclid(column) == b[0].div_euclid(column)) {
        let by_height = |&i: &usize| run[i][1];
        let indices = 0..run.len();
        let lowest = indices.clone().min_by_key(by_height).unwrap_or(0);
        let highest = indices.max_by_key(by_height).unwrap_or(0);
        let mut kept = [0, lowest, highest, run.len() - 1];
        kept.sort_unstable();
        for i in kept {
            if out.last() != Some(&run[i]) {
                out.push(run[i]);
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a long history would lose its peaks, or a file would grow with its number of steps.
    #[test]
    fn a_thinned_line_keeps_its_peaks() {
        let mut line: Vec<[i32; 2]> = (0..100_000).map(|i| [i / 20, (i % 7) * 3]).collect();
        line[54_321][1] = -999;
        let thinned = thin(&line, 10);
        assert!(thinned.len() <= 4 * 501, "{}", thinned.len());
        assert!(thinned.contains(&line[54_321]));
        assert_eq!(thinned.first(), line.first());
        assert_eq!(thinned.last(), line.last());
    }
}
