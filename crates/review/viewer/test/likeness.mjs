// Structural similarity of two pictures (Wang et al., "Image quality assessment", 2004) on brightness, in windows of 8 × 8
// pixels every 4 pixels, averaged over the windows that a mask allows.

const [C1, C2] = [(0.01 * 255) ** 2, (0.03 * 255) ** 2];

const brightness = ({ data }, n) => 0.299 * data[4 * n] + 0.587 * data[4 * n + 1] + 0.114 * data[4 * n + 2];

export function likeness(a, b, isCounted) {
  let [sum, count] = [0, 0];
  for (let y = 0; y + 8 <= a.height; y += 4) {
    for (let x = 0; x + 8 <= a.width; x += 4) {
      if (!isCounted(x + 4, y + 4)) continue;
      let [ma, mb, aa, bb, ab] = [0, 0, 0, 0, 0];
      for (let n = 0; n < 64; n++) {
        const at = (y + (n >> 3)) * a.width + x + (n & 7);
        const [va, vb] = [brightness(a, at), brightness(b, at)];
        ma += va / 64;
        mb += vb / 64;
        aa += (va * va) / 64;
        bb += (vb * vb) / 64;
        ab += (va * vb) / 64;
      }
      const [sa, sb, sab] = [aa - ma * ma, bb - mb * mb, ab - ma * mb];
      sum += ((2 * ma * mb + C1) * (2 * sab + C2)) / ((ma * ma + mb * mb + C1) * (sa + sb + C2));
      count++;
    }
  }
  return { value: sum / Math.max(count, 1), count };
}
