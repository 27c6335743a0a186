# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""A second truth for 7-Scenes: poses from structure from motion (Brachmann et al., On the Limits of
Pseudo Ground Truth in Visual Camera Re-Localization, ICCV 2021), published beside KinectFusion's as
pgt/sfm/7scenes/redkitchen_train.txt. They are under the licence of 7-Scenes and not part of this
repository: docs/redkitchen_truth.md.
"""
import re
import sys
from pathlib import Path

REDKITCHEN = "seq-01"  # the sequence of redkitchen that 7scenes_redkitchen is
FPS = 30.0  # stamps of 7-Scenes are frame numbers over this
LINE = re.compile(r"(seq-\d+)/frame-(\d+)\.color\.png((?: \S+){7,8})$")


def rotate(quaternion, vector):
    """`vector` turned by a unit quaternion (w, x, y, z)."""
    w, x, y, z = quaternion
    a, b, c = vector
    # v + 2 w (q x v) + 2 q x (q x v)
    u = (y * c - z * b, z * a - x * c, x * b - y * a)
    t = (y * u[2] - z * u[1], z * u[0] - x * u[2], x * u[1] - y * u[0])
    return tuple(v + 2 * (w * i + j) for v, i, j in zip(vector, u, t))


def write_trajectory(published, sequence, out):
    """Writes the poses of one sequence as a trajectory in TUM format, world from camera."""
    try:
        text = Path(published).read_text()
    except (OSError, UnicodeDecodeError) as error:
        sys.exit(f"{published}: {error}, expected the published poses of redkitchen")
    lines = {}
    for number, line in enumerate(text.splitlines(), 1):
        match = LINE.match(line)
        if not match:
            sys.exit(f"{published}:{number}: expected seq-NN/frame-NNNNNN.color.png qw qx qy qz tx ty tz f")
        if match[1] != sequence:
            continue
        w, x, y, z, *translation = (float(word) for word in match[3].split()[:7])
        back = (w, -x, -y, -z)  # the file has camera from world
        centre = [-value for value in rotate(back, translation)]
        words = [f"{int(match[2]) / FPS:.6f}", *(f"{v:.7g}" for v in centre),
                 *(f"{v:.7g}" for v in (*back[1:], w))]
        lines[int(match[2])] = " ".join(words)
    if not lines:
        sys.exit(f"{published}: no pose of {sequence} in it")
    Path(out).write_text("\n".join(lines[key] for key in sorted(lines)) + "\n")
