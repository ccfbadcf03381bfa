#!/usr/bin/env bash
# Builds the site of docs/ in target/site, with mdBook. Pages outside of docs/ become pages of the site.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

mdbook_version=0.5.4
target=${CARGO_TARGET_DIR:-target}
mdbook=$target/mdbook/bin/mdbook
if [[ $("$mdbook" --version 2>/dev/null || true) != *"$mdbook_version" ]]; then
    echo "site: building mdBook $mdbook_version (minutes, once)" >&2
    CARGO_PROFILE_RELEASE_OPT_LEVEL=0 CARGO_PROFILE_RELEASE_LTO=off cargo install --quiet --locked --root "$target/mdbook" --no-default-features --features search "mdbook@$mdbook_version"
fi

work=$(mktemp -d "$target/site.XXXXXX")
trap 'rm -rf "$work"' EXIT
cp -r docs "$work/src"
mv "$work/src/book.toml" "$work/"
sed 's|](docs/|](|g' CONTRIBUTING.md >"$work/src/contributing.md"
sed 's|](docs/|](|g' CHANGELOG.md >"$work/src/changes.md"
sed -i 's|](\.\./CONTRIBUTING\.md|](contributing.md|g; s|](\.\./CHANGELOG\.md|](changes.md|g; s|](\.\./README\.md|](README.md|g' \
    "$work"/src/*.md
cp -r python/notebooks "$work/src/notebooks"
sed -i 's|](\.\./python/notebooks|](notebooks|g' "$work"/src/*.md
outside=$(grep -n '](\.\./' "$work"/src/*.md || true)
[[ -z $outside ]] || { printf 'site: these links lead out of the site:\n%s\n' "$outside" >&2 && exit 1; }

rm -rf "$target/site"
"$mdbook" build --dest-dir "$(realpath "$target")/site" "$work"
echo "site: $target/site/index.html"
