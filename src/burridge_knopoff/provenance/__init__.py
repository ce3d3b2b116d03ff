"""The origin of a result: fingerprints of its sources, checksums, records of studies, and atomic writing of files."""
