"""Pictures of pages beside those that a person has looked at: fonts and rounding may differ, what is drawn may not."""

import io
import os
from pathlib import Path

import numpy as np
from PIL import Image

STORED = Path(__file__).parent / "shots"
SMALL = (160, 120)
MOST = 4.0  # of 255, the mean over all pixels of the small pictures


def compare(locator, name):
    """Compare a picture of a part of a page with a stored one; BOUNCE_SHOTS=write stores it."""
    png = locator.screenshot()
    path = STORED / f"{name}.png"
    picture = Image.open(io.BytesIO(png)).convert("RGB").resize(SMALL, Image.Resampling.BOX)
    if os.environ.get("BOUNCE_SHOTS") == "write":
        picture.save(path)
    stored = np.asarray(Image.open(path).convert("RGB"), float)
    assert np.abs(np.asarray(picture, float) - stored).mean() < MOST, f"{name}: the page looks otherwise now"
