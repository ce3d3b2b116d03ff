"""Contents of bad config files, with words of the error message `key: got X, expected Y`.

tests/study/bad_changes.py has more, as changes to a good config.
"""

from burridge_knopoff.laws import LAWS

GRID = "a: [0.1]\n"
STATES = "initial: {minus: {}}\n"
GOOD = f"study: x\n{GRID}{STATES}"
BLOCKS = "[{}]".format(", ".join(["0.1"] * 1025))

# name of the case: (content of the file, words of the message)
BAD_FILES: dict[str, tuple[str | bytes, list[str]]] = {
    # The file.
    "empty": ("", ["got nothing, expected keys with values"]),
    "comment": ("# nothing yet\n", ["got nothing, expected"]),
    "null": ("null\n", ["got nothing, expected"]),
    "text": ("hello world\n", ["got 'hello world', expected keys"]),
    "number": ("3\n", ["got 3, expected keys"]),
    "list": ("- study\n- a\n", ["got ['study', 'a'], expected keys"]),
    "documents": (f"{GOOD}---\n{GOOD}", ["not YAML (line 4)", "another document"]),
    "binary": (b"\x00\x01\xff\xfe\x80\x81", ["cannot be read: not UTF-8 text"]),
    "latin1": (GOOD.encode() + "# é".encode("latin1"), ["not UTF-8 text"]),
    "utf16": (GOOD.encode("utf-16"), ["not UTF-8 text"]),
    "nul": (f"{GOOD}v: 0.1\0\n", ["not YAML", "special characters"]),
    "control": (f"{GOOD}v: \x07\n", ["not YAML", "special characters"]),
    "tab": (
        "study: x\na:\n\t- 0.1\n",
        ["not YAML (line 3)", "cannot start any token: a tab, where YAML takes spaces only"],
    ),
    "open": ("study: x\na: [0.1\ninitial: {minus: {}}\n", ["not YAML (line 3)"]),
    "colon": (f"{GOOD}v 0.1\n", ["not YAML (line 5)", "':'"]),
    "json": ('{"study": "x", "a": [0.1', ["not YAML (line 1)"]),
    "directive": (f"%YAML 9.9\n---\n{GOOD}", ["not YAML (line 1)", "incompatible"]),
    # Features of YAML beyond keys, lists and values.
    "object": (f"{GOOD}v: !!python/object/apply:os.system ['touch made']\n", ["not YAML (line 4)", "python/object"]),
    "tag": (f"{GOOD}v: !speed 0.1\n", ["not YAML (line 4)", "!speed"]),
    "alias": (f"{GOOD}v: *speed\n", ["not YAML (line 4)", "alias"]),
    "set": (f"study: x\na: !!set {{0.1, 0.2}}\n{STATES}", ["got 0.1 (line 2) as a key"]),
    "pairs": (f"study: x\n{GRID}initial: !!omap [minus: {{}}]\n", ["initial: [('minus', {})]", "named entries"]),
    "bytes": (f"study: !!binary aGVsbG8=\n{GRID}{STATES}", ["study: b'hello'"]),
    "date": (f"{GOOD}v: 2020-01-01\n", ["v: datetime.date(2020, 1, 1)", "a number"]),
    "no_date": (f"{GOOD}v: 2020-99-99\n", ["not YAML", "month"]),
    "template": (f"__use_yte__: true\n{GOOD}", ["__use_yte__: unknown key"]),
    "merged": (f"base: &b {{minus: {{}}}}\nstudy: x\n{GRID}initial: {{<<: *b}}\n", ["base: unknown key"]),
    # Keys.
    "twice": (f"{GOOD}a: [0.2]\n", ["a: given twice (line 4)", "expected once"]),
    "twice_quoted": (f"study: x\n{GRID}initial: {{minus: {{}}, 'minus': {{}}}}\n", ["minus: given twice (line 3)"]),
    "twice_at_once": (f"study: y\n{GOOD}", ["study: given twice (line 2)"]),
    "twice_inside": (
        f"study: x\na:\n  - {{from: 0, to: 1, from: 0.5, step: 0.5}}\n{STATES}",
        ["from: given twice (line 3)"],
    ),
    "unknown": (f"{GOOD}windows: 7000\n", ["windows: unknown key", "window"]),
    "upper_case": (f"{GOOD}Window: 7000\n", ["Window: unknown key", "window"]),
    "key_of_two_lines": (f'{GOOD}"a\\nb": 1\n', ["'a\\nb': unknown key"]),
    "key_with_space": (f'{GOOD}"window ": 1\n', ["'window ': unknown key"]),
    "long_key": (f"{GOOD}{'k' * 900}: 1\n", ["kkk", "unknown key"]),
    "number_as_key": (f"{GOOD}7: 1\n", ["got 7 (line 4) as a key"]),
    "yes_as_key": (f"study: x\n{GRID}initial: {{on: {{}}}}\n", ["got on (line 3) as a key"]),
    "list_as_key": (f"{GOOD}? [a, b]\n: 1\n", ["(line 4) as a key, expected text"]),
    "missing": (f"{GRID}{STATES}", ["study: missing"]),
    # Names.
    "slash": (f"study: a/b\n{GRID}{STATES}", ["study: 'a/b'", "letters, digits"]),
    "parent": (f"study: ..\n{GRID}{STATES}", ["study: '..'"]),
    "here": (f"study: .\n{GRID}{STATES}", ["study: '.'"]),
    "absolute": (f"study: /tmp/x\n{GRID}{STATES}", ["study: '/tmp/x'"]),
    "minus": (f"study: -x\n{GRID}{STATES}", ["study: '-x'"]),
    "space": (f"study: my study\n{GRID}{STATES}", ["study: 'my study'"]),
    "long_name": (f"study: {'n' * 300}\n{GRID}{STATES}", ["study: 'nnn", "at most 64"]),
    "umlaut": (f"study: Größe\n{GRID}{STATES}", ["study: 'Größe'"]),
    "no": (f"study: no\n{GRID}{STATES}", ["study: False"]),
    "line_break": (f'study: "x\\n"\n{GRID}{STATES}', ["study: 'x\\n'"]),
    "shell": (f"study: $(touch made)\n{GRID}{STATES}", ["study: '$(touch made)'"]),
    "state_name": (f"study: x\n{GRID}initial: {{a/b: {{position: [0, 0], velocity: [0, 0]}}}}\n", ["initial: 'a/b'"]),
    # Numbers.
    "octal": (f"{GOOD}transient: 03000\n", ["transient: '03000'", "a number"]),
    "hexadecimal": (f"{GOOD}window: 0x1F\n", ["window: '0x1F'", "a number"]),
    "sixties": (f"{GOOD}window: 1:30\n", ["window: '1:30'", "a number"]),
    "underline": (f"{GOOD}window: 7_000\n", ["window: '7_000'", "a number"]),
    "not_a_number": (f"{GOOD}v: .nan\n", ["v: nan", "a number"]),
    "infinite": (f"{GOOD}window: .inf\n", ["window: inf", " 1e+09"]),
    "overflow": (f"{GOOD}window: 1.0e+400\n", ["window: inf", " 1e+09"]),
    "huge": (f"{GOOD}window: 1.0e+12\n", ["window: 1000000000000.0", " 1e+09"]),
    "negative": (f"{GOOD}transient: -3000\n", ["transient: -3000", "above 0"]),
    "text_for_number": (f"{GOOD}step: '1e-4'\n", ["step: '1e-4'", "a number"]),
    "comma": (f"{GOOD}step: 0,001\n", ["step: '0,001'", "a number"]),
    "yes_for_number": (f"{GOOD}v: yes\n", ["v: True", "a number"]),
    "nothing_for_number": (f"{GOOD}v:\n", ["v: None", "a number"]),
    "half_batch": (f"{GOOD}batches: 2.5\n", ["batches: 2.5", "a whole number"]),
    # Grids.
    "no_values": (f"study: x\na: []\n{STATES}", ["a: []", "at least 1"]),
    "large_a": (f"study: x\na: [0.1, 101]\n{STATES}", ["a[1]: 101", " 100"]),
    "one_name": (
        f"study: x\na: [0.1, 0.10001]\n{STATES}",
        ["a: got 0.1 and 0.10001, which share the file name a0.1000.nc", "a_digits"],
    ),
    "crooked": (f"study: x\na: [{{from: 0, to: 1, step: 0.3}}]\n{STATES}", ["a[0].step: 0.3", "divide"]),
    "falling": (f"study: x\na: [{{from: 1, to: 0, step: 0.1}}]\n{STATES}", ["a[0].to: 0", "at least from"]),
    "billion": (f"study: x\na: [{{from: 0, to: 1, step: 1.0e-9}}]\n{STATES}", ["a[0].step: 1e-09", "100000 values"]),
    "many_points": (
        "study: x\na: [{from: 0, to: 1, step: 0.001}]\ninitial:\n"
        + "".join(f"  s{n}: {{position: [0, 0], velocity: [0, 0]}}\n" for n in range(1000)),
        ["a: 2002000 points", "2 laws, 1000 initial states, 1001 values", "at most 100000"],
    ),
    # Laws and chains.
    "unknown_law": (
        f"{GOOD}laws: {{cubic: {{}}}}\n",
        ["laws.cubic: got 'cubic', expected", f"{' | '.join(LAWS)}, or a formula"],
    ),
    "unknown_kind": (f"{GOOD}laws: {{mine: {{law: cubic}}}}\n", ["laws.mine.law: got 'cubic', expected", *LAWS]),
    "unknown_number": (
        f"{GOOD}laws: {{stribeck: {{sigm: 0.1}}}}\n",
        ["laws.stribeck.sigm: not a parameter", "eta | sigma"],
    ),
    "no_laws": (f"{GOOD}laws: {{}}\n", ["laws: {}", "at least 1"]),
    "list_of_laws": (f"{GOOD}laws: [linearized]\n", ["laws: ['linearized']", "named entries"]),
    "law_name": (f"{GOOD}laws: {{Mine: {{formula: 1 - a*u}}}}\n", ["laws: 'Mine'", "small letters"]),
    "law_text": (f"{GOOD}laws: {{linearized: 1 - a*u}}\n", ["laws.linearized: '1 - a*u'"]),
    "number_text": (
        f"{GOOD}laws: {{stribeck: {{sigma: small}}}}\n",
        ["laws.stribeck.sigma: 'small'", "a finite number"],
    ),
    "formula_syntax": (
        f"{GOOD}laws: {{m: {{formula: 1 -}}}}\n",
        ["laws.m: got '1 -', expected", "not a formula"],
    ),
    "formula_number": (f"{GOOD}laws: {{m: {{formula: 1}}}}\n", ["laws.m.formula: got 1, expected text"]),
    "formula_name": (f"{GOOD}laws: {{m: {{formula: 1 - b*u}}}}\n", ["laws.m.b: missing"]),
    "formula_unused": (f"{GOOD}laws: {{m: {{formula: 1 - a*u, b: 2}}}}\n", ["laws.m.b: not a parameter"]),
    "formula_law": (
        f"{GOOD}laws: {{m: {{formula: 1 - a*u, law: linearized}}}}\n",
        ["laws.m: got law and formula, expected one"],
    ),
    "formula_call": (f"{GOOD}laws: {{m: {{formula: open(u)}}}}\n", ["laws.m: got 'open(u)'", "expected"]),
    "formula_lines": (f'{GOOD}laws: {{m: {{formula: "1 - a*(u\\n)"}}}}\n', ["laws.m: ", "not a formula"]),
    "formula_start": (f"{GOOD}laws: {{m: {{formula: 1.1 - a*u}}}}\n", ["laws.m: ", "its value at u = 0 is 1.1"]),
    "formula_none": (f"{GOOD}laws: {{m: {{formula: a*u}}}}\n", ["laws.m: ", "its value at u = 0 is 0"]),
    "formula_pole_for_two_blocks": (
        f"{GOOD}laws: {{m: {{formula: 1/(1 - 0.3*a*u)}}}}\nchains: {{two_blocks: {{}}}}\n",
        ["chains.two_blocks.a: got 0.34, at which ", "laws.m: ", "at a = 0.34", "not analytic"],
    ),
    "formula_pole": (f"{GOOD}laws: {{m: {{formula: 1/(1 - a*u)}}}}\n", ["laws.m: ", "at a = 0.1", "not analytic"]),
    "formula_at_one_a": (
        f"study: x\na: [0.05, 0.1, 0.2]\n{STATES}laws: {{m: {{formula: log(3 - 2*a*u)/log(3)}}}}\n",
        ["laws.m: ", "at a = 0.2", "not analytic"],
    ),
    "law_speed": (
        f"{GOOD}laws: {{m: {{formula: log(3 - a*u)/log(3)}}}}\nv: 40\n",
        ["v: got 40.0, expected a velocity up to ten times which the law m is analytic"],
    ),
    "springs": (f"{GOOD}chain: {{coupling: [1, 2, 3]}}\n", ["chain.coupling: got 3 numbers, expected 1, or 2"]),
    "ring_springs": (
        f"{GOOD}chain: {{coupling: [1, 2], ends: ring}}\n",
        ["chain.coupling: got 2 numbers, expected 1, or 3"],
    ),
    "pulls": (f"{GOOD}chain: {{pulling: [1, 2]}}\n", ["chain.pulling: got 2 numbers, expected 1, or 3"]),
    "pull_word": (f"{GOOD}chain: {{pulling: all}}\n", ["chain.pulling: 'all'", "neighbours"]),
    "thresholds": (
        f"{GOOD}chain: {{threshold: [1]}}\n",
        ["chain.threshold: got a list of 1 number, expected a number, or a list of 3"],
    ),
    "weak": (f"{GOOD}chain: {{threshold: 0}}\n", ["chain.threshold: got 0, expected a number between 1e-06 and 1e+06"]),
    "spring_text": (f"{GOOD}chain: {{coupling: [1, stiff]}}\n", ["chain.coupling[1]: 'stiff'", "a number"]),
    "spring_word": (
        f"{GOOD}chain: {{coupling: stiff}}\n",
        ["chain.coupling: 'stiff'", "a number between 1e-06 and 1e+06 or a list"],
    ),
    "ends": (f"{GOOD}chain: {{ends: closed}}\n", ["chain.ends: 'closed'", "open | ring"]),
    "chain_key": (f"{GOOD}chain: {{block: 3}}\n", ["chain.block: unknown key (did you mean blocks?)"]),
    "other_blocks": (f"{GOOD}chain: {{blocks: 5}}\n", ["initial.minus: got numbers for 3 blocks, expected 5"]),
    "grid": (f"{GOOD}chain: {{grid: [2, 2]}}\n", ["initial.minus: got numbers for 3 blocks, expected 4"]),
    "grid_of_floats": (f"{GOOD}chain: {{grid: [1.5, 2]}}\n", ["chain.grid[0]: 1.5", "a whole number"]),
    "grid_springs": (
        f"{GOOD}chain: {{grid: [3, 1], coupling: [1, 2, 3]}}\n",
        ["chain.coupling: got 3 numbers, expected 1, or 2: along rows and columns"],
    ),
    "grid_ring": (f"{GOOD}chain: {{grid: [3, 1], ends: ring}}\n", ["chain.ends: got ring, expected open"]),
    "no_springs": (
        f"{GOOD}chain: {{springs: none.txt}}\n",
        ["chain.springs: ", "none.txt: cannot be read: No such file"],
    ),
    "springs_of_two_lines": (
        f'{GOOD}chain: {{springs: "a\\nb"}}\n',
        ["chain.springs: got 'a\\nb'", "name of a text file"],
    ),
    "springs_with_zero": (
        f'{GOOD}chain: {{springs: "a\\0b"}}\n',
        ["chain.springs: got 'a\\x00b'", "name of a text file"],
    ),
    "springs_number": (f"{GOOD}chain: {{springs: 3}}\n", ["chain.springs: 3", "name of a text file"]),
    "light": (f"{GOOD}chain: {{mass: 0}}\n", ["chain.mass: got 0, expected a number between 1e-06 and 1e+06"]),
    "masses": (
        f"{GOOD}chain: {{mass: [1]}}\n",
        ["chain.mass: got a list of 1 number, expected a number, or a list of 3"],
    ),
    "drawn_law": (
        f"{GOOD}chain: {{mass: {{random: normal, low: 1, high: 2, seed: 1}}}}\n",
        ["chain.mass.random: 'normal'"],
    ),
    "drawn_seed": (f"{GOOD}chain: {{mass: {{random: uniform, low: 1, high: 2}}}}\n", ["chain.mass.seed: missing"]),
    "drawn_low": (
        f"{GOOD}chain: {{threshold: {{random: uniform, low: 0, high: 2, seed: 1}}}}\n",
        ["chain.threshold.low: got 0, expected a number between 1e-06"],
    ),
    "drawn_high": (
        f"{GOOD}chain: {{threshold: {{random: uniform, low: 3, high: 2, seed: 1}}}}\n",
        ["chain.threshold.high: got 2.0, expected at least low (3.0)"],
    ),
    "drawn_blocks": (
        f"study: x\n{GRID}initial: {{m: {{position: {{random: uniform, low: -1, high: 1, seed: 1}}, velocity: 0}}}}\n",
        ["chain.blocks: missing, expected the number of blocks"],
    ),
    "map_of_no_law": (f"{GOOD}basins: {{a: {{stribeck: [0.1]}}}}\n", ["basins.a.stribeck: unknown key", "linearized"]),
    "figure_law": (f"{GOOD}figures: {{law: stribeck}}\n", ["figures.law: 'stribeck'", "linearized | nonlinear"]),
    "solver_law": (f"{GOOD}solver: {{stribeck: series}}\n", ["solver.stribeck: unknown key", "linearized, nonlinear"]),
    # States, and keys that are incompatible.
    "unknown_state": (
        f"study: x\n{GRID}initial: {{middle: {{}}}}\n",
        ["initial.middle: got no position and velocity", "minus | plus"],
    ),
    "no_velocity": (
        f"study: x\n{GRID}initial: {{m: {{position: [0, 0]}}}}\n",
        ["initial.m.velocity: got none, expected"],
    ),
    "many_blocks": (
        f"study: x\n{GRID}initial: {{m: {{position: {BLOCKS}, velocity: {BLOCKS}}}}}\n",
        ["initial.m.position: [0.1,", "at most 1024"],
    ),
    "two_lengths": (
        f"study: x\n{GRID}initial: {{m: {{position: [0, 0], velocity: [0, 0]}}, plus: {{}}}}\n",
        ["initial: got different numbers of positions", "m: 2, plus: 3"],
    ),
    "backward": (
        f"study: x\n{GRID}initial: {{m: {{position: [0, 0], velocity: [0, -0.1]}}}}\n",
        ["initial.m.velocity: -0.1", "one_sided"],
    ),
    "no_map": (
        f"{GOOD}solver: {{nonlinear: map}}\n",
        ["solver.nonlinear: 'map'", "not linear in the speed", "series | rk4"],
    ),
    "steep_map": (
        f"study: x\na: [0.1, 2.5]\n{STATES}solver: {{linearized: map}}\n",
        ["solver.linearized: 'map'", "at a = 2.5", "steeper than 2"],
    ),
    "ring_map": (
        f"{GOOD}solver: {{linearized: map}}\nchain: {{ends: ring}}\n",
        ["solver.linearized: 'map'", "open ends"],
    ),
    "outside": (f"{GOOD}basins: {{a: {{linearized: [0.2]}}}}\n", ["basins.a.linearized: 0.2", "a value of the grid"]),
    "box": (f"{GOOD}chains: {{position: [1, -1]}}\n", ["chains.position: [1, -1]", "low < high"]),
    # More than a job can compute.
    "steps": (
        f"{GOOD}solver: {{linearized: rk4}}\nstep: 1.0e-9\n",
        ["step: 1e-09", "at least 3e-06 in a run of 10000"],
    ),
    "samples": (f"{GOOD}sampling: 1.0e-5\n", ["sampling: 1e-05", "at least 0.001 over a time of 10000"]),
    "trajectory": (
        f"{GOOD}trajectory: 7000\ntrajectory_sampling: 1.0e-4\n",
        ["trajectory_sampling: 0.0001", "at least 0.0007 over a time of 7000"],
    ),
    "pixels": (f"{GOOD}basins: {{a: {{linearized: [0.1]}}, pixels: 16384}}\n", ["basins.pixels: 16384", "numbers"]),
    "pairs_of_states": (f"{GOOD}basins: {{pairs: 10000000}}\n", ["basins.pairs: 10000000", "numbers"]),
}

#: The first case of a valid file with an invalid key.
FIRST_OF_KEYS = list(BAD_FILES).index("twice")
