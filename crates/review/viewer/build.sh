#!/bin/sh
# Builds the viewer of reviews: dist/viewer.js (with three.js in it), dist/viewer.css and the hashes by which a page's
# Content-Security-Policy names both. Needs node and npm; the results are committed, so that building Petroglyph needs
# neither.
set -e
cd "$(dirname "$0")"
npm ci --no-audit --no-fund --loglevel=error
npx esbuild src/main.js --bundle --minify --format=iife --target=es2020 --charset=ascii --legal-comments=none \
    --outfile=dist/viewer.js --log-level=warning
npx esbuild src/style.css --minify --outfile=dist/viewer.css --log-level=warning
cp node_modules/three/LICENSE dist/LICENSE-three.txt
# In a page the texts stand between tags exactly as they are in the files.
for file in dist/viewer.js dist/viewer.css; do
    node -e '
        const bytes = require("fs").readFileSync(process.argv[1]);
        console.log(require("crypto").createHash("sha256").update(bytes).digest("base64"));' "$file"
done > dist/hashes.txt
wc -c dist/viewer.js dist/viewer.css
gzip -9 -c dist/viewer.js | wc -c
