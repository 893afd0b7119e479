"""The problems, in the order of the table."""
from . import waves, ends, quiet, joint_waves, statics, kirsch, beam, joints, softening, dilation, incline, strength, footing, damping, \
    conservation  # noqa: F401
