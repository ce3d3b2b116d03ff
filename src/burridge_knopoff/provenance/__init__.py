"""The origin of a result: fingerprints of its sources, seals, records of studies, and atomic writing of files."""
