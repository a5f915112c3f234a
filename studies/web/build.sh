#!/usr/bin/env bash
# Builds studies/web/integrator.wasm.gz and its hash. Usage: bash studies/web/build.sh
# With rustup's wasm32 target where there is one, else with Debian's rustc-web (unpacked below target/, not installed).
set -euo pipefail
cd "$(dirname "$0")/../.."

target=wasm32-unknown-unknown
# The processor of this machine is no processor for a page, and its paths are nobody's business.
export RUSTFLAGS="--remap-path-prefix=$PWD=. --remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=cargo"
export CARGO_INCREMENTAL=0
build() {
    cargo rustc -p web --lib --crate-type cdylib --locked --target $target --profile wasm --target-dir target/wasm "$@"
}

if [ -d "$(rustc --print target-libdir --target $target)" ]; then
    build
else
    debian=$PWD/target/rustc-web
    if [ ! -x "$debian/usr/bin/rustc" ]; then
        mkdir -p "$debian/deb"
        # What the package rustc-web needs, by its own word: its library and LLVM carry version numbers in their names.
        packages=$(apt-cache depends --recurse --no-suggests --no-recommends --no-conflicts --no-breaks --no-replaces --no-enhances rustc-web |
            grep -E '^(rustc-web|libstd-rust-web[-.0-9a-z]*|libllvm[0-9.]+)$' | sort -u)
        # shellcheck disable=SC2086
        (cd "$debian/deb" && apt-get download rust-web-src $packages && for deb in *.deb; do dpkg -x "$deb" ..; done)
    fi
    library=$debian/usr/lib/$(uname -m)-linux-gnu
    printf '#!/bin/sh\nLD_LIBRARY_PATH=%s exec %s "$@"\n' "$library" "$debian/usr/bin/rustc" >"$debian/rustc"
    chmod +x "$debian/rustc"
    linker=$(rustc --print sysroot)/lib/rustlib/$(rustc -vV | sed -n 's/^host: //p')/bin/rust-lld
    CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=$linker RUSTC=$debian/rustc RUSTC_BOOTSTRAP=1 build -Zbuild-std=std,panic_abort
fi

# Without name and date: the same module gives the same bytes.
gzip -9 -n -c target/wasm/$target/wasm/web.wasm >studies/web/integrator.wasm.gz
(cd studies/web && sha256sum integrator.wasm.gz | tee integrator.wasm.gz.sha256)
