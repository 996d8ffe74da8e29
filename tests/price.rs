//! Prices: closed forms, what holds for all of them, and the document that defines them.

use crate::common::Slicer;
use crate::common::{binary_stl, quiet, solids};
use cusp_slicer::job::{Backend, Job, JobOptions, ModelOptions, Options};
use cusp_slicer::price::{Finish, Price, PriceError, PriceItem, PriceKind, Prices, QuantityBreak};

const DOCUMENT: &str = include_str!("../docs/price.md");

/// The prices of the document's example.
fn example() -> Prices {
    let (_, rest) = DOCUMENT.split_once("```json\n").unwrap();
    serde_json::from_str(rest.split_once("```").unwrap().0).unwrap()
}

fn free() -> Prices {
    serde_json::from_str(r#"{ "currency": "EUR" }"#).unwrap()
}

fn item(copies: usize, resin_ml: f64, print_time_s: f64) -> PriceItem {
    PriceItem {
        copies,
        resin_ml,
        support_ml: None,
        print_time_s,
    }
}

fn amount(price: &Price, kind: PriceKind) -> i64 {
    let line = price.lines.iter().find(|line| line.kind == kind);
    line.map_or(0, |line| line.amount)
}

/// Numbers from 0 up to 1, the same in every run.
fn numbers() -> impl FnMut() -> f64 {
    let mut state = 1_u64;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 33) as f64 / f64::from(1_u32 << 31)
    }
}

/// Prices with breaks, and an order.
fn drawn(next: &mut impl FnMut() -> f64) -> (Prices, Vec<PriceItem>) {
    let prices = Prices {
        currency: "EUR".to_owned(),
        setup: (next() * 1000.0).floor(),
        machine_per_h: next() * 300.0,
        resin_per_ml: next() * 40.0,
        supports: next(),
        finishes: vec![Finish {
            name: "sanded".to_owned(),
            per_copy: next() * 200.0,
            per_ml: next() * 10.0,
        }],
        quantity_breaks: vec![
            QuantityBreak {
                copies: 5,
                discount: next(),
            },
            QuantityBreak {
                copies: 20,
                discount: next(),
            },
        ],
        minimum: (next() * 4000.0).floor(),
    };
    let mut one = || item((next() * 14.0) as usize + 1, next() * 30.0, next() * 9000.0);
    let items = vec![one(), one()];
    (prices, items)
}

#[test]
fn the_example_of_the_document_costs_what_it_says() {
    let order = [item(12, 8.4, 6300.0)];
    let price = example().price(&order, Some("sanded")).unwrap();
    let said = |name: &str| {
        let start = format!("| {name} | ");
        let row = DOCUMENT.lines().find_map(|line| line.strip_prefix(&*start));
        let amount = row.map(|row| row.split_once(" |").unwrap().0);
        amount.map_or(0, |amount| amount.parse().unwrap())
    };
    for kind in PriceKind::ALL {
        assert_eq!(amount(&price, kind), said(kind.name()), "{}", kind.name());
    }
    assert_eq!(price.total, said("total"));
    assert_eq!(price.written(price.total), "77.81");
    assert!(DOCUMENT.contains("77.81 €"));
    // A small order costs the minimum.
    let price = example().price(&[item(1, 1.0, 3600.0)], None).unwrap();
    // 500 + 180 + 14.5 + 2.175, of which the last two are rounded alone.
    assert_eq!(amount(&price, PriceKind::Resin), 15);
    assert_eq!(amount(&price, PriceKind::Supports), 2);
    assert_eq!(amount(&price, PriceKind::Minimum), 1500 - 697);
    assert_eq!(price.total, 1500);
}

#[test]
fn the_document_names_every_field_with_its_bounds_and_every_line() {
    let prices = serde_json::to_value(example()).unwrap();
    let mut names: Vec<&String> = prices.as_object().unwrap().keys().collect();
    for list in ["finishes", "quantity_breaks"] {
        names.extend(prices[list][0].as_object().unwrap().keys());
    }
    let unbounded = ["name", "copies"];
    for name in names
        .into_iter()
        .filter(|name| !unbounded.contains(&name.as_str()))
    {
        let start = format!("| `{name}` | ");
        let row = DOCUMENT.lines().find_map(|line| line.strip_prefix(&*start));
        let row = row.unwrap_or_else(|| panic!("no row of {name}"));
        let cells: Vec<&str> = row.split(" | ").collect();
        let Ok(most) = cells[1].parse::<f64>() else {
            continue;
        };
        // The bound itself is accepted, and numbers beyond it are not.
        for (value, is_fine) in [
            (0.0, true),
            (most, true),
            (-1.0, false),
            (most * 2.0, false),
        ] {
            let mut changed = prices.clone();
            let place = [
                ("per_copy", "/finishes/0"),
                ("per_ml", "/finishes/0"),
                ("discount", "/quantity_breaks/0"),
            ];
            let place = place.into_iter().find(|(field, _)| field == name);
            let holder = changed.pointer_mut(place.map_or("", |(_, it)| it)).unwrap();
            holder[name] = value.into();
            let read = serde_json::from_value::<Prices>(changed);
            let accepted = read.is_ok_and(|prices| prices.check().is_ok());
            assert_eq!(accepted, is_fine, "{name}: {value}");
        }
    }
    for kind in PriceKind::ALL {
        assert!(
            DOCUMENT.contains(&format!("\n| `{}` | ", kind.name())),
            "{}",
            kind.name()
        );
    }
}

#[test]
fn each_line_is_rounded_alone_and_halves_go_up() {
    let prices = Prices {
        machine_per_h: 1.0,
        resin_per_ml: 0.5,
        supports: 1.0,
        ..free()
    };
    for (resin_ml, time_s, lines) in [
        (1.0, 1800.0, [1, 1, 1]),
        (0.99, 1799.0, [0, 0, 0]),
        (3.0, 5400.0, [2, 2, 2]),
        (2.98, 5399.0, [1, 1, 1]),
    ] {
        let price = prices.price(&[item(1, resin_ml, time_s)], None).unwrap();
        let kinds = [PriceKind::Machine, PriceKind::Resin, PriceKind::Supports];
        assert_eq!(kinds.map(|kind| amount(&price, kind)), lines);
    }
    // A copy's half is rounded with the others of its kind, not before.
    let price = prices.price(&[item(10, 0.25, 0.0)], None).unwrap();
    assert_eq!(amount(&price, PriceKind::Resin), 1);
}

#[test]
fn supports_of_the_plan_cost_their_resin_alone() {
    let prices = Prices {
        resin_per_ml: 100.0,
        supports: 0.15,
        ..example()
    };
    let lines = |items: &[PriceItem]| {
        let price = prices.price(items, Some("sanded")).unwrap();
        let kinds = [PriceKind::Resin, PriceKind::Supports, PriceKind::Finish];
        kinds.map(|kind| amount(&price, kind))
    };
    let supported = |support_ml| PriceItem {
        support_ml: Some(support_ml),
        ..item(2, 10.0, 0.0)
    };
    assert_eq!(lines(&[item(2, 10.0, 0.0)]), [2000, 300, 2 * 150 + 80]);
    assert_eq!(lines(&[supported(1.5)]), [2000, 0, 2 * 150 + 68]);
    // Where nothing needs a support, nothing is estimated either.
    assert_eq!(lines(&[supported(0.0)]), [2000, 0, 2 * 150 + 80]);
    // Of several models those without supports are estimated.
    let both = [supported(1.5), item(2, 10.0, 0.0)];
    assert_eq!(lines(&both), [4000, 300, 4 * 150 + 148]);
    for bad in [f64::NAN, -1e-9, 10.1] {
        let error = prices.price(&[supported(bad)], None).unwrap_err();
        assert!(error.to_string().contains("support_ml"), "{error}");
    }
}

#[test]
fn the_total_is_the_sum_of_the_lines_and_at_least_the_minimum() {
    let mut next = numbers();
    let mut kinds = Vec::new();
    for _ in 0..2000 {
        let (prices, items) = drawn(&mut next);
        let finish = (next() < 0.5).then_some("sanded");
        let price = prices.price(&items, finish).unwrap();
        let sum: i64 = price.lines.iter().map(|line| line.amount).sum();
        assert_eq!(price.total, sum);
        assert!(price.total >= prices.minimum as i64);
        assert!(price.total >= prices.setup as i64);
        assert_eq!(
            price.copies,
            items.iter().map(|item| item.copies).sum::<usize>()
        );
        // Only a discount is negative, and no line is 0.
        for line in &price.lines {
            assert_eq!(line.amount < 0, line.kind == PriceKind::Discount);
            assert_ne!(line.amount, 0);
            kinds.push(line.kind);
        }
    }
    for kind in PriceKind::ALL {
        assert!(kinds.contains(&kind), "never drawn: {}", kind.name());
    }
}

#[test]
fn more_resin_time_and_copies_never_cost_less_but_across_a_break() {
    let mut next = numbers();
    let mut across = 0;
    for _ in 0..2000 {
        let (prices, items) = drawn(&mut next);
        let total = |items: &[PriceItem], prices: &Prices| {
            prices.price(items, Some("sanded")).unwrap().total
        };
        let before = total(&items, &prices);
        let mut more = items.clone();
        more[0].resin_ml *= 1.0 + next();
        assert!(total(&more, &prices) >= before);
        let mut more = items.clone();
        more[1].print_time_s *= 1.0 + next();
        assert!(total(&more, &prices) >= before);
        let mut more = items.clone();
        more[1].copies += 1;
        let unbroken = Prices {
            quantity_breaks: Vec::new(),
            ..prices.clone()
        };
        assert!(total(&more, &unbroken) >= total(&items, &unbroken));
        across += usize::from(total(&more, &prices) < before);
        // A discount never costs anything.
        assert!(before <= total(&items, &unbroken));
    }
    // The exception that the document names is one.
    assert!(across > 0);
}

#[test]
fn the_last_break_that_is_reached_counts() {
    let prices = Prices {
        resin_per_ml: 100.0,
        ..example()
    };
    for (copies, discount) in [
        (9, 0.0),
        (10, 0.05),
        (49, 0.05),
        (50, 0.12),
        (1_000_000, 0.12),
    ] {
        // On several items as well: what counts are all copies.
        let order = [item(copies - 1, 1.0, 0.0), item(1, 1.0, 0.0)];
        let price = prices.price(&order, None).unwrap();
        let discounted = 115.0 * copies as f64;
        let taken = -amount(&price, PriceKind::Discount);
        assert!((taken as f64 - discount * discounted).abs() <= 0.5);
    }
}

#[test]
fn what_cannot_be_priced_is_named() {
    let order = [item(1, 1.0, 1.0)];
    let fails = |prices: Prices, order: &[PriceItem], finish| prices.price(order, finish);
    let code = |result: Result<Price, PriceError>| {
        let error = serde_json::to_value(result.unwrap_err()).unwrap();
        error["code"].as_str().unwrap().to_owned()
    };
    for currency in ["", "EURO", "eur", "€€€", "E R"] {
        let prices = Prices {
            currency: currency.to_owned(),
            ..free()
        };
        assert_eq!(code(fails(prices, &order, None)), "bad-prices");
    }
    for bad in [f64::NAN, f64::INFINITY, -1e-9] {
        let prices = Prices {
            resin_per_ml: bad,
            ..free()
        };
        assert_eq!(code(fails(prices, &order, None)), "price-out-of-bounds");
        for order in [item(1, bad, 1.0), item(1, 1.0, bad)] {
            assert_eq!(code(fails(free(), &[order], None)), "price-out-of-bounds");
        }
    }
    let most = usize::MAX;
    let order_of = |copies| [item(copies, 1.0, 1.0), item(copies, 1.0, 1.0)];
    assert_eq!(
        code(fails(free(), &order_of(most), None)),
        "price-out-of-bounds"
    );
    assert_eq!(
        code(fails(free(), &order_of(0), None)),
        "price-out-of-bounds"
    );
    assert_eq!(code(fails(free(), &[], None)), "price-out-of-bounds");
    let dear = Prices {
        machine_per_h: 1e12,
        ..free()
    };
    let long = [item(1_000_000, 0.0, 1e12)];
    assert_eq!(code(fails(dear, &long, None)), "price-out-of-bounds");
    let error = fails(example(), &order, Some("gilded")).unwrap_err();
    assert_eq!(
        error.to_string(),
        "there is no finish gilded; known are raw, sanded"
    );
    let none = Prices {
        finishes: Vec::new(),
        ..example()
    };
    let error = fails(none, &order, Some("gilded")).unwrap_err();
    assert_eq!(
        error.to_string(),
        "there is no finish gilded; the prices name none"
    );
    let mut prices = example();
    prices.finishes[0].name = "sanded".to_owned();
    assert_eq!(code(fails(prices, &order, None)), "bad-prices");
    for copies in [10, 5] {
        let mut prices = example();
        prices.quantity_breaks[1].copies = copies;
        assert_eq!(code(fails(prices, &order, None)), "bad-prices");
    }
}

#[test]
fn amounts_are_written_with_the_digits_of_the_currency() {
    for (currency, written) in [
        ("EUR", ["0.00", "0.05", "1234.56", "-0.70"]),
        ("JPY", ["0", "5", "123456", "-70"]),
        ("KWD", ["0.000", "0.005", "123.456", "-0.070"]),
    ] {
        let prices = Prices {
            currency: currency.to_owned(),
            ..free()
        };
        let price = prices.price(&[item(1, 0.0, 0.0)], None).unwrap();
        assert_eq!(
            [0, 5, 123_456, -70].map(|amount| price.written(amount)),
            written
        );
    }
}

#[test]
fn copies_on_a_plate_are_priced_by_their_shares_of_its_time() {
    let prices = Prices {
        machine_per_h: 3600.0,
        resin_per_ml: 1000.0,
        ..free()
    };
    let model = || Slicer::load(&binary_stl(&solids::sphere(3.0, 3))).unwrap();
    let options = Options {
        pixels: Some([400, 300]),
        pitch_mm: Some(0.1),
        backend: Backend::Cpu,
        ..Options::default()
    };
    let mut alone = model();
    let report = pollster::block_on(alone.plan(&options, &mut quiet)).unwrap();
    let mut plate = Job::new(vec![model().into_model()]);
    let copies = |copies| JobOptions {
        options: options.clone(),
        models: vec![ModelOptions {
            copies,
            ..ModelOptions::default()
        }],
        ..JobOptions::default()
    };
    let one = pollster::block_on(plate.plan(&copies(1), &mut quiet)).unwrap();
    assert_eq!(one.price_items(), report.price_items(1));
    let six = pollster::block_on(plate.plan(&copies(6), &mut quiet)).unwrap();
    let together = prices.price(&six.price_items(), None).unwrap();
    let apart = prices.price(&report.price_items(6), None).unwrap();
    assert_eq!((together.copies, apart.copies), (6, 6));
    let resin = |price| amount(price, PriceKind::Resin);
    assert_eq!(resin(&together), resin(&apart));
    // A cent a second.
    let machine = |price| amount(price, PriceKind::Machine) as f64;
    assert!((machine(&together) - six.print_time_s).abs() <= 0.6);
    assert!((machine(&apart) - 6.0 * report.print_time_s).abs() <= 0.6);
    // The plate twice.
    let twice = six.plates[0].price_items(2);
    assert_eq!(twice[0].copies, 12);
}
