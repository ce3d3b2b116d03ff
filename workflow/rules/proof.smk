# The synchronized orbit of the paper's chain and its loss of stability, in ball arithmetic.


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
        config=uses("proof", [f"laws.{law}" for law in STUDY.proved_laws], MODELS[1:]),
        sources=sources("proof"),
    message:
        "proof: the loss of synchrony in ball arithmetic"
    script:
        "../scripts/proof.py"
