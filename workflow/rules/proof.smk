# Proof: the synchronized orbit of the paper's chain, and where it is lost, in ball arithmetic.


rule proof:
    """Prove by ball arithmetic that the synchronized orbit exists and where it loses its stability."""
    output:
        f"{SUMMARY}/proof.nc",
        report(
            f"{SUMMARY}/proof.txt",
            caption="../report/proof_text.rst",
            category="Synchronization",
            labels={"result": "what is proved, and what is assumed", "paper": "none"},
        ),
    log:
        f"{RESULTS}/logs/proof.log",
    benchmark:
        f"{RESULTS}/benchmarks/proof.tsv"
    group:
        group("summaries")
    params:
        model=lambda wildcards: proved_config(STUDY),
        sources=sources("proof"),
        seals=seals,
    message:
        "proof: the loss of synchrony in ball arithmetic"
    script:
        "../scripts/proof.py"
