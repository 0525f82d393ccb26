"""The fuzzer of the public API; `tools/fuzz_api.py` is its command."""
