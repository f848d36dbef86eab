"""The errors that explain themselves to whoever typed a command."""

from mend.localization.logs.log import LogError
from mend.localization.pictures.failure import PictureError
from mend.localization.scan import InvalidScanError
from mend.maps.vector_map import VectorMapError
from mend.robots.vision.color_model import ColorModelError
from mend.server.access.principals_file import PrincipalsFileError
from mend.server.errors import ServiceError
from mend.server.journal.backup import BackupError
from mend.server.journal.file_lock import JournalLockedError
from mend.server.journal.journal import JournalOpenError, JournalReadError
from mend.server.journal.migrations import JournalSchemaError
from mend.server.settings import WrongSettingsError
from mend.sim.world import WorldUnavailableError
from mend.tasks.library import NotInLibraryError
from mend.tasks.plugins import PluginError
from mend.tasks.problem import InvalidFileError

KNOWN_ERRORS = (
    ColorModelError,
    InvalidFileError,
    InvalidScanError,
    BackupError,
    JournalLockedError,
    JournalOpenError,
    JournalReadError,
    JournalSchemaError,
    LogError,
    NotInLibraryError,
    PictureError,
    PluginError,
    PrincipalsFileError,
    ServiceError,
    VectorMapError,
    WorldUnavailableError,
    WrongSettingsError,
)
