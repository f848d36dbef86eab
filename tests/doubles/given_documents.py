"""Documents that a service has as if they came with it: uploads are checked in every world."""

from collections.abc import Mapping

from mend.server.documents import DocumentKind
from mend.server.fixed_documents import GivenFiles


def given_documents(trees: Mapping[str, str], scenes: Mapping[str, str]) -> GivenFiles:
    """The texts of trees and scenes by name."""
    return GivenFiles({DocumentKind.TREE: trees, DocumentKind.SCENE: scenes})
