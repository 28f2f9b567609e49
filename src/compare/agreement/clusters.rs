/// Groups images by name, such as that of their subject, and returns the indices of the images of
/// every group.
///
/// `names` has one entry per image. Groups are sorted by name, images within a group by index. Each
/// image without a name forms a group of its own, and these groups come first.
pub fn clusters(names: &[Option<&str>]) -> Vec<Vec<usize>> {
    let mut clusters: Vec<(Option<&str>, Vec<usize>)> = Vec::new();
    let mut order: Vec<usize> = (0..names.len()).collect();
    order.sort_by_key(|&i| (names[i], i));
    for i in order {
        match clusters.last_mut() {
            Some((name, members)) if name.is_some() && *name == names[i] => members.push(i),
            _ => clusters.push((names[i], vec![i])),
        }
    }
    clusters.into_iter().map(|(_, members)| members).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_of_a_name_are_together_and_images_without_alone() {
        let names = [Some("b"), None, Some("a"), Some("b"), None];
        assert_eq!(clusters(&names), [vec![1], vec![4], vec![2], vec![0, 3]]);
        assert!(clusters(&[]).is_empty());
    }
}
