"""The colour model: what each object's colour looks like, learned from pictures.

Two cues: histograms of hue and saturation that are projected back into any camera's picture, and
the tint of a level top, its colour over the table's in the same light, which the head camera
measures whatever the light is.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.errors import WrongInputError
from mend.robots.vision.blob import Mask

Histogram = NDArray[np.float32]

FILE_VERSION = 4
Tint = tuple[float, float, float]
"""The colour (BGR) of something level over that of the table in the same light."""

_RANGES = [0, 180, 0, 256]
_KERNEL = np.ones((3, 3), np.uint8)
_NOISE_SEED = 1
_TOLD_APART = 2.0
"""Colours are told apart that are this many times their joint inaccuracy apart."""


@dataclass(frozen=True, slots=True)
class ColorSettings:
    """How finely colours are told apart, and what is too grey or too dark to have one.

    Saturations and values are OpenCV's (0 to 255). The training limits are the stricter ones, so
    that a histogram is learned from pixels that surely have the object's colour. A bin belongs to
    an object only where its histogram has at least `min_share` of its peak. An object of which less
    than `hued_share` of the pixels surely have a hue has none, only noise. Samples are also
    learned from with other light (`gains`) and with noise of `noise` grey levels, because
    pictures at work have both. Objects whose histograms have at least the share `alike` in common
    have the same hue and share their bins.
    """

    hue_bins: int = 30
    saturation_bins: int = 32
    min_saturation: int = 60
    min_value: int = 30
    min_training_saturation: int = 70
    min_training_value: int = 35
    min_share: float = 0.02
    hued_share: float = 0.5
    gains: tuple[float, ...] = (0.65, 1.0, 1.35)
    noise: float = 8.0
    alike: float = 0.5


@dataclass(frozen=True, slots=True, eq=False)
class Sample:
    """A picture (BGR) and the mask (non-zero inside) of one object in it."""

    bgr: NDArray[np.uint8]
    mask: Mask


@dataclass(frozen=True, slots=True, eq=False)
class LearnedColor:
    """What one object's pixels are like, over bins of hue and saturation.

    `histogram` is that of the pixels that surely have a hue, its peak 1; empty for an object that
    is too grey or too dark. `shown` are all bins that its pixels fall into at work; `dark`: in
    little light some are too dark for any.
    """

    histogram: Histogram
    shown: NDArray[np.bool_]
    dark: bool


class Segmentation:
    """A picture in which every pixel has the number of its bin of hue and saturation."""

    def __init__(
        self,
        bins: NDArray[np.uint16],
        owned: Mapping[str, NDArray[np.bool_]],
        shown: Mapping[str, NDArray[np.bool_]],
    ) -> None:
        """`owned` says of each bin, of 0 for what is grey, and of the last for what is too dark to
        have a colour, whether an object has it.

        `shown` says whether the object may show it, though another may have more of it.
        """
        self._bins = bins
        self._owned = owned
        self._shown = shown

    def mask(self, name: str) -> Mask:
        """Where the colours of one object are: 255 there, 0 elsewhere.

        Objects whose colours the cameras cannot tell apart have each other's. Raises
        `WrongInputError` for an object that the model was not trained for.
        """
        return np.where(_of(self._owned, name)[self._bins], 255, 0).astype(np.uint8)

    def may_be(self, name: str) -> NDArray[np.bool_]:
        """Which pixels may be an object's, as far as their colour says. Raises as `mask` does."""
        return _of(self._shown, name)[self._bins]

    def tells(self, name: str) -> NDArray[np.bool_]:
        """Which pixels' colour says whether they are an object's. Raises as `mask` does.

        What is too dark to have one says nothing of an object that may be as dark.
        """
        shown = _of(self._shown, name)
        return np.asarray((self._bins < len(shown) - 1) | ~shown[-1])

    def within(self, mask: Mask) -> "Segmentation":
        """The pixels inside a mask alone, in one row."""
        return Segmentation(self._bins[np.newaxis, mask > 0], self._owned, self._shown)

    def share(self, name: str, us: NDArray[np.intp], vs: NDArray[np.intp]) -> float:
        """The share of some pixels that have an object's colours. Raises as `mask` does."""
        return float(_of(self._owned, name)[self._bins[vs, us]].mean()) if len(us) else 0.0


def _of(bins: Mapping[str, NDArray[np.bool_]], name: str) -> NDArray[np.bool_]:
    if name not in bins:
        known = ", ".join(sorted(bins))
        raise WrongInputError(f"the colour model does not know '{name}'; it knows {known}")
    return bins[name]


class ColorModel:
    """Hue-saturation histograms and tints per object.

    An object that is too grey or too dark to have a hue has an empty histogram; then only its
    tint, if there is one, says what it looks like.
    """

    def __init__(
        self,
        learned: Mapping[str, LearnedColor],
        settings: ColorSettings,
        tints: Mapping[str, Tint] | None = None,
    ) -> None:
        if not learned:
            raise WrongInputError("a colour model holds at least one object, not 0")
        self._learned = dict(learned)
        self._histograms = {name: each.histogram for name, each in learned.items()}
        self._settings = settings
        self.tints: Mapping[str, Tint] = dict(tints or {})
        self._owned = self._share_out()
        self._shown = {
            name: self._owned[name] | np.r_[False, each.shown.ravel(), each.dark]
            for name, each in learned.items()
        }

    def _share_out(self) -> dict[str, NDArray[np.bool_]]:
        """Which bins each object has: those of which it, or one of the same hue, has the most."""
        names = list(self._histograms)
        stack = np.stack([self._histograms[name].ravel() for name in names])
        most = np.where(stack.max(axis=0) >= self._settings.min_share, stack.argmax(axis=0), -1)
        common = np.array([np.minimum(each, stack).sum(axis=1) for each in stack])
        either = np.array([np.maximum(each, stack).sum(axis=1) for each in stack])
        same_hue = common >= self._settings.alike * np.maximum(either, 1e-9)
        return {
            name: np.r_[False, (most >= 0) & same_hue[index][most] & (stack[index] > 0), False]
            for index, name in enumerate(names)
        }

    @property
    def names(self) -> tuple[str, ...]:
        """The objects that it knows."""
        return tuple(self._histograms)

    @property
    def settings(self) -> ColorSettings:
        return self._settings

    def has_hue(self, name: str) -> bool:
        """Whether an object is coloured enough to be found by hue and saturation."""
        return bool(self._owned[name].any())

    def look_alike(self, one: str, other: str) -> bool:
        """Whether the cameras cannot tell two objects' colours apart."""
        first, second = self.tints.get(one), self.tints.get(other)
        if first is None or second is None:
            common = np.minimum(self._histograms[one], self._histograms[other]).sum()
            either = np.maximum(self._histograms[one], self._histograms[other]).sum()
            return bool(common >= self._settings.alike * either)
        apart = np.abs(np.array(first) - second) / (tint_sigma(first) + tint_sigma(second))
        return bool(apart.max() < _TOLD_APART)

    def may_pass_for(self, one: str, other: str) -> bool:
        """Whether most of what an object shows may be another's, as far as its hue says.

        What has no hue passes for anything that has none. An object that it does not know may be
        anything.
        """
        if one not in self._learned or other not in self._learned:
            return True
        histogram = self._histograms[one].ravel()
        if not histogram.any() or not self.has_hue(other):
            return not histogram.any() and not self.has_hue(other)
        return bool(histogram[self._shown[other][1:-1]].sum() >= histogram.sum() / 2)

    @classmethod
    def train(
        cls,
        samples: Mapping[str, Sequence[Sample]],
        settings: ColorSettings | None = None,
        tints: Mapping[str, Tint] | None = None,
    ) -> "ColorModel":
        """Learn each object's colours from its samples."""
        chosen = settings or ColorSettings()
        return cls(
            {name: learn(name, each, chosen) for name, each in samples.items()}, chosen, tints
        )

    def segment(self, bgr: NDArray[np.uint8]) -> Segmentation:
        """Give every pixel of a picture the number of its bin."""
        hsv = _hue_saturation_value(bgr)
        hue = (np.arange(256) * self._settings.hue_bins // 180).astype(np.uint16)
        saturation = (np.arange(256) * self._settings.saturation_bins // 256).astype(np.uint16)
        bins = hue[hsv[:, :, 0]] * np.uint16(self._settings.saturation_bins)
        bins += saturation[hsv[:, :, 1]] + np.uint16(1)
        bins[hsv[:, :, 1] < self._settings.min_saturation] = 0
        too_dark = self._settings.hue_bins * self._settings.saturation_bins + 1
        bins[hsv[:, :, 2] < self._settings.min_value] = too_dark
        return Segmentation(bins, self._owned, self._shown)

    def save(self, path: Path) -> None:
        """Write the model to one .npz file."""
        settings = self._settings
        with path.open("wb") as file:
            np.savez_compressed(
                file,
                version=np.array(FILE_VERSION),
                names=np.array(self.names),
                histograms=np.stack([each.histogram for each in self._learned.values()]),
                shown=np.stack([each.shown for each in self._learned.values()]),
                dark=np.array([each.dark for each in self._learned.values()]),
                limits=np.array(
                    [
                        settings.min_saturation,
                        settings.min_value,
                        settings.min_training_saturation,
                        settings.min_training_value,
                    ]
                ),
                min_share=np.array(settings.min_share),
                tinted=np.array(list(self.tints)),
                tints=np.array(list(self.tints.values())),
            )

    @classmethod
    def load(cls, path: Path) -> "ColorModel":
        """Read a model that `save` wrote. Raises `WrongInputError` saying what is wrong."""
        try:
            with path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
                return cls._from_arrays(path, dict(arrays))
        except FileNotFoundError as error:
            raise WrongInputError(f"there is no colour model at '{path}'") from error
        except (
            BadZipFile,
            ValueError,
            OSError,
            KeyError,
            IndexError,
            TypeError,
            EOFError,
        ) as error:
            raise WrongInputError(f"'{path}' is not a colour model: {error}") from error

    @classmethod
    def _from_arrays(cls, path: Path, arrays: Mapping[str, NDArray[Any]]) -> "ColorModel":
        version = int(arrays["version"])
        if version != FILE_VERSION:
            raise WrongInputError(
                f"'{path}' is a colour model of version {version}; this reads {FILE_VERSION}"
            )
        names, histograms = arrays["names"].tolist(), arrays["histograms"].astype(np.float32)
        shown, dark = arrays["shown"].astype(np.bool_), arrays["dark"].astype(np.bool_)
        fitting = histograms.ndim == 3 and shown.shape == histograms.shape
        if not fitting or not len(names) == len(histograms) == len(dark):
            raise WrongInputError(f"'{path}' is not a colour model: its histograms do not fit")
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
        tints = {
            name: (float(blue), float(green), float(red))
            for name, (blue, green, red) in zip(
                arrays["tinted"].tolist(), arrays["tints"], strict=True
            )
        }
        learned = map(LearnedColor, histograms, shown, dark.tolist())
        return cls(dict(zip(names, learned, strict=True)), settings, tints)


def tint_sigma(tint: Tint | NDArray[np.float64]) -> NDArray[np.float64]:
    """How exactly each channel of a tint is measured: rounding, and light that is uneven."""
    sigma: NDArray[np.float64] = 0.008 + 0.02 * np.asarray(tint, np.float64)
    return sigma


def learn(name: str, samples: Sequence[Sample], settings: ColorSettings) -> LearnedColor:
    """What one object's colour looks like.

    Raises `WrongInputError` for a mask that does not fit its picture.
    """
    bins = [settings.hue_bins, settings.saturation_bins]
    surely = (0, settings.min_training_saturation, settings.min_training_value)
    at_work = (0, settings.min_saturation, settings.min_value)
    total, shown = np.zeros(bins, np.float32), np.zeros(bins, np.float32)
    pixels = dark = 0
    rng = np.random.default_rng(_NOISE_SEED)
    for sample in samples:
        if sample.bgr.shape[:2] != sample.mask.shape:
            raise WrongInputError(
                f"a mask of '{name}' is {sample.mask.shape}, its picture {sample.bgr.shape[:2]}"
            )
        # Masks and rims are a pixel off now and then.
        whole = np.where(sample.mask > 0, 255, 0).astype(np.uint8)
        inside = np.asarray(cv2.erode(whole, _KERNEL), np.uint8)
        left, top, width, height = cv2.boundingRect(inside)
        # With the rim that the median filter reaches over.
        patch = np.s_[max(top - 1, 0) : top + height + 1, max(left - 1, 0) : left + width + 1]
        inside, clean = inside[patch], sample.bgr[patch]
        for gain in settings.gains:
            noise = rng.normal(0.0, settings.noise, clean.shape)
            bgr = np.clip(clean * gain + noise, 0, 255).astype(np.uint8)
            hsv = _hue_saturation_value(bgr)
            total += _histogram(hsv, surely, inside, bins)
            shown += _histogram(hsv, at_work, inside, bins)
            pixels += cv2.countNonZero(inside)
            dark += int(np.count_nonzero(inside[hsv[:, :, 2] < settings.min_value]))
    shown = _blur(shown)
    may_show = (shown > 0) & (shown >= settings.min_share * shown.max())
    may_be_dark = dark > settings.min_share * pixels
    if total.sum() <= settings.hued_share * pixels:
        return LearnedColor(np.zeros(bins, np.float32), may_show, may_be_dark)
    smooth = _blur(total)
    return LearnedColor(np.asarray(smooth / smooth.max(), np.float32), may_show, may_be_dark)


def _histogram(
    hsv: NDArray[np.uint8], lowest: tuple[int, int, int], inside: Mask, bins: list[int]
) -> Histogram:
    usable = cv2.bitwise_and(cv2.inRange(hsv, lowest, (180, 255, 255)), inside)
    return np.asarray(cv2.calcHist([hsv], [0, 1], usable, bins, _RANGES), np.float32)


def _hue_saturation_value(bgr: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """OpenCV's HSV without single stray pixels: noise turns the hue of dark colours.

    A median keeps rims sharp; a blur would mix them into the colours of other objects.
    """
    return np.asarray(cv2.cvtColor(cv2.medianBlur(bgr, 3), cv2.COLOR_BGR2HSV), np.uint8)


def _blur(histogram: Histogram) -> Histogram:
    """Spread each bin a little to its neighbours; hue is a circle, so red meets red."""
    wrapped = np.vstack([histogram[-1:], histogram, histogram[:1]])
    return np.asarray(cv2.GaussianBlur(wrapped, (3, 3), 0)[1:-1], np.float32)
