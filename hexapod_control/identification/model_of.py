"""The model of a platform whose parameters can be identified."""

from hexapod_control.identification.leg_model import Tolerances
from hexapod_control.identification.linear_model import LinearModel
from hexapod_control.identification.rotary_model import RotaryModel
from hexapod_control.linear import LinearPlatform
from hexapod_control.rotary import RotaryHexapod
from manipulator.errors import InvalidInput
from manipulator.kinematics import Kinematics


def model_of(kinematics: Kinematics, tolerances: Tolerances) -> RotaryModel | LinearModel:
    """InvalidInput for a machine that is no platform."""
    if isinstance(kinematics, RotaryHexapod):
        return RotaryModel(kinematics.geometry, tolerances)
    if isinstance(kinematics, LinearPlatform):
        return LinearModel(kinematics.geometry, tolerances)
    raise InvalidInput(f'no model to identify for a {type(kinematics).__name__}')
