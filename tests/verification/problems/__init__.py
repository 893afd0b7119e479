"""The problems, in the order of the table."""
from . import waves, ends, joint_waves, statics, beam, joints, incline, damping, conservation  # noqa: F401
