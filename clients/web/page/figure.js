// Draws a person's landmarks into a picture: a dot for each, a line for each bone between two.

// Chains of connected landmarks of @mediapipe/pose: face, mouth, trunk, arms with hands, legs with
// feet.
const CHAINS = [[8, 6, 5, 4, 0, 1, 2, 3, 7], [10, 9], [24, 12, 11, 23, 24],
                [11, 13, 15, 17, 19, 15, 21], [12, 14, 16, 18, 20, 16, 22],
                [23, 25, 27, 29, 31, 27], [24, 26, 28, 30, 32, 28]];
const LEAST_VISIBILITY = 0.25;
const TRACKED_FROM = 0.75;  // Below it a joint is inferred, as in footing-skeleton's gate.

// landmarks: x and y from 0 to 1. A bone with an inferred end is thinner and paler.
export function drawFigure(context, landmarks, width, height) {
  const visibility = index => landmarks[index]?.visibility ?? 0;
  const place = index => [landmarks[index].x * width, landmarks[index].y * height];
  context.strokeStyle = context.fillStyle = '#ffb02e';
  for (const chain of CHAINS) {
    for (let i = 1; i < chain.length; ++i) {
      const least = Math.min(visibility(chain[i - 1]), visibility(chain[i]));
      if (least < LEAST_VISIBILITY) continue;
      const tracked = least >= TRACKED_FROM;
      context.lineWidth = tracked ? 3 : 1;
      context.globalAlpha = tracked ? 1 : 0.5;
      context.beginPath();
      context.moveTo(...place(chain[i - 1]));
      context.lineTo(...place(chain[i]));
      context.stroke();
    }
  }
  context.globalAlpha = 1;
  for (let i = 0; i < landmarks.length; ++i) {
    if (visibility(i) < LEAST_VISIBILITY) continue;
    context.beginPath();
    context.arc(...place(i), 4, 0, 2 * Math.PI);
    context.fill();
  }
}
