"""A fuzzer of the whole public API: see `tools/fuzz_api.py`."""
