// Switches the layers of a PDF off one by one in pdf.js, by what the panel of layers in Firefox calls, and says how many
// pixels that changes.
//
//     npm install pdfjs-dist@4.10.38 @napi-rs/canvas@0.1.65
//     node bench/switched_layers.mjs FILE.pdf
//
// A line for each layer: its name and the pixels that changed at 100 dots an inch.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

// Packages are those of the folder in which this is called.
const here = createRequire(`${process.cwd()}/`);
const { createCanvas, Path2D, DOMMatrix, ImageData } = here("@napi-rs/canvas");
Object.assign(globalThis, { Path2D, DOMMatrix, ImageData });
const { getDocument } = await import(pathToFileURL(here.resolve("pdfjs-dist/legacy/build/pdf.mjs")));

const data = new Uint8Array(readFileSync(process.argv[2]));
const pdf = await getDocument({ data, verbosity: 0 }).promise;
const page = await pdf.getPage(1);
const viewport = page.getViewport({ scale: 100 / 72 });

async function drawn(config) {
  const canvas = createCanvas(Math.ceil(viewport.width), Math.ceil(viewport.height));
  const canvasContext = canvas.getContext("2d");
  canvasContext.fillStyle = "white";
  canvasContext.fillRect(0, 0, canvas.width, canvas.height);
  await page.render({ canvasContext, viewport, optionalContentConfigPromise: Promise.resolve(config) }).promise;
  return canvasContext.getImageData(0, 0, canvas.width, canvas.height).data;
}

const all = await pdf.getOptionalContentConfig();
const before = await drawn(all);
for (const [id, { name }] of Object.entries(all.getGroups())) {
  const config = await pdf.getOptionalContentConfig();
  config.setVisibility(id, false);
  const after = await drawn(config);
  let changed = 0;
  for (let at = 0; at < before.length; at += 4) {
    const by = Math.max(...[0, 1, 2].map((channel) => Math.abs(before[at + channel] - after[at + channel])));
    changed += by > 8;
  }
  console.log(`${name}: ${changed}`);
}
