// Reads what a page holds: numbers and pictures in base64.

/** Bytes of a text in base64. */
export function bytes(text) {
  const letters = atob(text);
  const array = new Uint8Array(letters.length);
  for (let n = 0; n < letters.length; n++) array[n] = letters.charCodeAt(n);
  return array;
}

/** 32-bit numbers. */
export const floats = (text) => new Float32Array(bytes(text).buffer);

/** Points in voxels, of shares of their box. */
export function points({ low, size, points }) {
  const shares = new Uint16Array(bytes(points).buffer);
  const voxels = new Float32Array(shares.length);
  for (let n = 0; n < shares.length; n++) voxels[n] = low[n % 3] + (size[n % 3] * shares[n]) / 65535;
  return voxels;
}

/** A mesh: corners in voxels and indices. */
export function mesh(source) {
  const corners = points(source);
  const { indices, bits } = source;
  const buffer = bytes(indices).buffer;
  return { corners, indices: bits === 16 ? new Uint16Array(buffer) : new Uint32Array(buffer) };
}

/** A picture that is a part of the page. */
export function picture(uri) {
  return new Promise((resolve, reject) => {
    const image = new Image();
    image.onload = () => resolve(image);
    image.onerror = () => reject(new Error("a picture of this page is damaged"));
    image.src = uri;
  });
}

/** The pixels of a picture: width, height, and bytes of red, green, blue and alpha. */
export async function pixels(uri) {
  const image = await picture(uri);
  const canvas = document.createElement("canvas");
  canvas.width = image.naturalWidth;
  canvas.height = image.naturalHeight;
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(image, 0, 0);
  return context.getImageData(0, 0, canvas.width, canvas.height);
}
