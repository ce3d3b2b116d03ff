# The synchronized orbit of the paper's chain and its loss of stability, in ball arithmetic.

NO_PROOF = (
    ""
    if STUDY.proved_laws
    else "nothing to prove: the proof covers the paper's chain of 3 blocks and its two laws (linearized: any v, at most "
    f"{LARGEST_V:g} under a symmetric contact; nonlinear: v = {NONLINEAR_V:g})"
)


rule proof:
    """Prove by ball arithmetic that the synchronized orbit exists and where it loses its stability."""
    output:
        f"{RESULTS}/summary/proof.nc",
        shown("proof.txt", "what is proved, and what is assumed", "Synchronization"),
    log:
        f"{RESULTS}/logs/proof.log",
    benchmark:
        f"{RESULTS}/benchmarks/proof.tsv"
    params:
        config=uses([f"laws.{law}" for law in STUDY.proved_laws], MODELS[1:], stage="proof", refusal=NO_PROOF),
        sources=sources("proof"),
    message:
        "proof: the loss of synchrony in ball arithmetic"
    script:
        "../scripts/proof.py"
