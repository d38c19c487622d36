use super::Memo;

/// Requests an entry, and tells whether it had to be computed.
fn ask(memo: &Memo<usize>, entry: usize, value: usize) -> bool {
    let mut computed = false;
    let found = *memo.get(entry, |found| {
        *found = value;
        computed = true;
    });
    assert_eq!(found, value, "entry {entry}");
    computed
}

/// Counts the requested entries without sorting them.
fn asked_count(memo: &Memo<usize>) -> usize {
    let mut count = 0;
    memo.each_asked(|_| count += 1);
    count
}

/// The requested entries, and the entries that hold a value.
fn entries(memo: &Memo<usize>) -> [Vec<usize>; 2] {
    [memo.asked(), memo.filled()]
}

#[test]
fn entries_are_computed_once_until_they_are_forgotten() {
    let mut memo = Memo::new(200);
    for entry in [3, 199, 64, 3] {
        let first = !memo.filled().contains(&entry);
        assert_eq!(ask(&memo, entry, entry), first);
    }
    assert_eq!(entries(&memo), [[3, 64, 199], [3, 64, 199]]);
    memo.forget(&[64, 65]);
    assert_eq!((memo.asked(), memo.peek(64)), (vec![3, 199], None));
    assert_eq!(asked_count(&memo), 2);
    memo.forget_all();
    assert_eq!(entries(&memo), [Vec::<usize>::new(), Vec::new()]);
    assert!(ask(&memo, 3, 7));
    memo.grow(300);
    assert!(ask(&memo, 299, 8) && !ask(&memo, 3, 7));
}

#[test]
fn entries_that_were_filled_ahead_count_as_requested_only_once_they_are() {
    let mut memo = Memo::new(100);
    assert!(ask(&memo, 70, 1));
    for entry in [2, 70, 90] {
        memo.fill_ahead(entry, |found| *found = 5);
    }
    assert_eq!(entries(&memo), [vec![70], vec![2, 70, 90]]);
    assert!(!ask(&memo, 90, 5) && !ask(&memo, 70, 5) && ask(&memo, 1, 6));
    assert_eq!(entries(&memo), [vec![1, 70, 90], vec![1, 2, 70, 90]]);
    memo.forget_all();
    assert!(ask(&memo, 2, 3));
    assert_eq!(entries(&memo), [[2], [2]]);
    assert_eq!(asked_count(&memo), 1);
}

#[test]
fn an_entry_whose_computation_panics_can_be_requested_again() {
    let mut memo = Memo::new(10);
    for _ in 0..2 {
        let failed = || memo.get(7, |_: &mut usize| panic!("no value"));
        let failed = std::panic::catch_unwind(std::panic::AssertUnwindSafe(failed));
        assert!(failed.is_err());
        assert_eq!((memo.asked(), memo.peek(7)), (vec![], None));
    }
    assert!(ask(&memo, 7, 3) && !ask(&memo, 7, 3));
    assert_eq!(entries(&memo), [[7], [7]]);
    memo.forget(&[7]);
    assert_eq!((memo.asked(), asked_count(&memo)), (vec![], 0));
    assert!(ask(&memo, 7, 4));
    memo.forget_all();
    assert_eq!(memo.asked(), Vec::<usize>::new());
}

#[test]
fn forgotten_values_are_used_again() {
    let mut memo = Memo::<[u64; 8]>::new(1_000);
    let empty = memo.memory();
    for round in 1..5 {
        for entry in 0..100 {
            memo.get(entry * round, |found| *found = [entry as u64; 8]);
        }
        let values = if round == 1 { 100 } else { 144 };
        let listed = 4 * 100;
        assert_eq!(memo.memory() - empty, values * 64 + listed, "round {round}");
        memo.forget_all();
        assert_eq!(memo.memory() - empty, 144 * 64, "round {round}");
    }
}

#[test]
fn threads_that_ask_for_one_entry_get_one_value() {
    for round in 0..200 {
        let memo = Memo::<[usize; 32]>::new(65);
        std::thread::scope(|scope| {
            let ask = || {
                let value = memo.get(64, |found| *found = [round; 32]);
                assert_eq!(*value, [round; 32]);
                std::ptr::from_ref(value) as usize
            };
            let others = [scope.spawn(ask), scope.spawn(ask)];
            let own = ask();
            for other in others {
                assert_eq!(other.join().unwrap(), own);
            }
        });
        assert_eq!(memo.filled(), [64]);
    }
}
