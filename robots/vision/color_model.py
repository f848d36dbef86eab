"""The colour model: which object each hue and saturation belongs to, learned from pictures."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from zipfile import BadZipFile

import cv2
import numpy as np
from numpy.typing import NDArray

from robots.vision.blob import Mask

Histogram = NDArray[np.float32]

FILE_VERSION = 1
MAX_OBJECTS = 255
_RANGES = [0, 180, 0, 256]
_KERNEL = np.ones((3, 3), np.uint8)
_NOISE_SEED = 1


class ColorModelError(Exception):
    """A colour model cannot be trained or read; the message says why."""


@dataclass(frozen=True, slots=True)
class ColorSettings:
    """How finely colours are told apart, and what is too grey or too dark to have one.

    Saturations and values are OpenCV's (0 to 255). The training limits are the stricter ones, so
    that a histogram is learned from pixels that surely have the object's colour. A bin belongs to
    an object only where its histogram has at least `min_share` of its peak. Samples are also
    learned from with other light (`gains`) and with noise of `noise` grey levels, because
    pictures at work have both.
    """

    hue_bins: int = 30
    saturation_bins: int = 32
    min_saturation: int = 60
    min_value: int = 30
    min_training_saturation: int = 70
    min_training_value: int = 35
    min_share: float = 0.02
    gains: tuple[float, ...] = (0.65, 1.0, 1.35)
    noise: float = 8.0


@dataclass(frozen=True, slots=True, eq=False)
class Sample:
    """A picture (BGR) and the mask (non-zero inside) of one object in it."""

    bgr: NDArray[np.uint8]
    mask: Mask


class Segmentation:
    """A picture in which every pixel is labelled with the object that owns its colour."""

    def __init__(self, labels: Mask, names: Sequence[str]) -> None:
        self._labels = labels
        self._names = {name: index + 1 for index, name in enumerate(names)}
        self._of_any: Mask | None = None

    def mask(self, name: str) -> Mask:
        """Where the colours of one object are: 255 there, 0 elsewhere.

        Raises `ColorModelError` for an object that the model was not trained for.
        """
        label = self._names.get(name)
        if label is None:
            known = ", ".join(sorted(self._names))
            raise ColorModelError(f"the colour model does not know '{name}'; it knows {known}")
        return np.asarray(cv2.inRange(self._labels, label, label), np.uint8)

    def of_any(self) -> Mask:
        """Where the colours of any object are; not to be written to."""
        if self._of_any is None:
            self._of_any = np.where(self._labels > 0, 255, 0).astype(np.uint8)
        return self._of_any

    def shown_at(self, us: NDArray[np.intp], vs: NDArray[np.intp]) -> str | None:
        """The object that most of some pixels show; None if it is less than half of them."""
        counts = np.bincount(self._labels[vs, us], minlength=len(self._names) + 1)
        name, label = max(self._names.items(), key=lambda each: int(counts[each[1]]))
        return name if counts[label] * 2 >= max(len(us), 1) else None


class ColorModel:
    """Hue-saturation histograms per object, each bin given to the object that has most of it."""

    def __init__(self, histograms: Mapping[str, Histogram], settings: ColorSettings) -> None:
        if not 0 < len(histograms) <= MAX_OBJECTS:
            raise ColorModelError(
                f"a colour model holds 1 to {MAX_OBJECTS} objects, not {len(histograms)}"
            )
        self._histograms = dict(histograms)
        self._settings = settings
        stack = np.stack(list(self._histograms.values()))
        owned = stack.max(axis=0) >= settings.min_share
        # Back-projecting the owners' numbers labels a picture for all objects in one pass.
        self._owners = np.where(owned, stack.argmax(axis=0) + 1, 0).astype(np.float32)

    @property
    def names(self) -> tuple[str, ...]:
        """The objects that it knows."""
        return tuple(self._histograms)

    @property
    def settings(self) -> ColorSettings:
        return self._settings

    def has_hue(self, name: str) -> bool:
        """Whether an object is coloured enough to be found by hue and saturation."""
        return bool(self._histograms[name].any())

    @classmethod
    def train(
        cls, samples: Mapping[str, Sequence[Sample]], settings: ColorSettings | None = None
    ) -> "ColorModel":
        """Learn each object's colours from its samples.

        Raises `ColorModelError` for an object of which no pixel is coloured enough.
        """
        chosen = settings or ColorSettings()
        return cls({name: learn(name, each, chosen) for name, each in samples.items()}, chosen)

    def segment(self, bgr: NDArray[np.uint8]) -> Segmentation:
        """Label every pixel of a picture with the object that owns its colour."""
        hsv = _hue_saturation_value(bgr)
        labels = cv2.calcBackProject([hsv], [0, 1], self._owners, _RANGES, 1)
        coloured = cv2.inRange(
            hsv, (0, self._settings.min_saturation, self._settings.min_value), (180, 255, 255)
        )
        return Segmentation(np.where(coloured > 0, labels, 0).astype(np.uint8), self.names)

    def save(self, path: Path) -> None:
        """Write the model to one .npz file."""
        settings = self._settings
        with path.open("wb") as file:
            np.savez_compressed(
                file,
                version=np.array(FILE_VERSION),
                names=np.array(self.names),
                histograms=np.stack(list(self._histograms.values())),
                limits=np.array(
                    [
                        settings.min_saturation,
                        settings.min_value,
                        settings.min_training_saturation,
                        settings.min_training_value,
                    ]
                ),
                min_share=np.array(settings.min_share),
            )

    @classmethod
    def load(cls, path: Path) -> "ColorModel":
        """Read a model that `save` wrote. Raises `ColorModelError` saying what is wrong."""
        try:
            with path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
                return cls._from_arrays(path, dict(arrays))
        except FileNotFoundError as error:
            raise ColorModelError(f"there is no colour model at '{path}'") from error
        except (
            BadZipFile,
            ValueError,
            OSError,
            KeyError,
            IndexError,
            TypeError,
            EOFError,
        ) as error:
            raise ColorModelError(f"'{path}' is not a colour model: {error}") from error

    @classmethod
    def _from_arrays(cls, path: Path, arrays: Mapping[str, NDArray[np.float32]]) -> "ColorModel":
        version = int(arrays["version"])
        if version != FILE_VERSION:
            raise ColorModelError(
                f"'{path}' is a colour model of version {version}; this reads {FILE_VERSION}"
            )
        names, histograms = arrays["names"].tolist(), arrays["histograms"].astype(np.float32)
        if histograms.ndim != 3 or len(names) != len(histograms):
            raise ColorModelError(f"'{path}' is not a colour model: its histograms do not fit")
        limits = [int(each) for each in arrays["limits"]]
        _, hue_bins, saturation_bins = histograms.shape
        settings = ColorSettings(
            hue_bins=hue_bins,
            saturation_bins=saturation_bins,
            min_saturation=limits[0],
            min_value=limits[1],
            min_training_saturation=limits[2],
            min_training_value=limits[3],
            min_share=float(arrays["min_share"]),
        )
        return cls(dict(zip(names, histograms, strict=True)), settings)


def learn(name: str, samples: Sequence[Sample], settings: ColorSettings) -> Histogram:
    """One object's histogram. Raises `ColorModelError` where no pixel is coloured enough."""
    bins = [settings.hue_bins, settings.saturation_bins]
    lowest = (0, settings.min_training_saturation, settings.min_training_value)
    total = np.zeros(bins, np.float32)
    rng = np.random.default_rng(_NOISE_SEED)
    for sample in samples:
        if sample.bgr.shape[:2] != sample.mask.shape:
            raise ColorModelError(
                f"a mask of '{name}' is {sample.mask.shape}, its picture {sample.bgr.shape[:2]}"
            )
        # Masks and rims are a pixel off now and then.
        inside = cv2.erode(np.where(sample.mask > 0, 255, 0).astype(np.uint8), _KERNEL)
        left, top, width, height = cv2.boundingRect(inside)
        # With the rim that the median filter reaches over.
        patch = np.s_[max(top - 1, 0) : top + height + 1, max(left - 1, 0) : left + width + 1]
        inside, clean = inside[patch], sample.bgr[patch]
        for gain in settings.gains:
            noise = rng.normal(0.0, settings.noise, clean.shape)
            bgr = np.clip(clean * gain + noise, 0, 255).astype(np.uint8)
            hsv = _hue_saturation_value(bgr)
            usable = cv2.bitwise_and(cv2.inRange(hsv, lowest, (180, 255, 255)), inside)
            total += cv2.calcHist([hsv], [0, 1], usable, bins, _RANGES)
    if total.max() <= 0:
        raise ColorModelError(
            f"no pixel of '{name}' is coloured enough to learn from; give brighter samples of it"
        )
    smooth = _blur(total)
    return np.asarray(smooth / smooth.max(), np.float32)


def _hue_saturation_value(bgr: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """OpenCV's HSV without single stray pixels: noise turns the hue of dark colours.

    A median keeps rims sharp; a blur would mix them into the colours of other objects.
    """
    return np.asarray(cv2.cvtColor(cv2.medianBlur(bgr, 3), cv2.COLOR_BGR2HSV), np.uint8)


def _blur(histogram: Histogram) -> Histogram:
    """Spread each bin a little to its neighbours; hue is a circle, so red meets red."""
    wrapped = np.vstack([histogram[-1:], histogram, histogram[:1]])
    return np.asarray(cv2.GaussianBlur(wrapped, (3, 3), 0)[1:-1], np.float32)
