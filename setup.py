"""The package `hexarm`: an ament_python package that pip can install as well."""

from pathlib import Path

from setuptools import Extension, find_packages, setup
from setuptools.command.build_ext import build_ext

from build_backend import LIBRARIES, build

NAME = 'hexarm'
PACKAGES = ['manipulator', 'hexapod_control', 'arm_control', 'bridge', 'hexarm']


class BuildLibraries(build_ext):
    """Builds the C libraries by their own commands: setuptools' need Python's headers."""

    def build_extension(self, ext: Extension) -> None:
        """Compiles one to where setuptools wants it."""
        build(ext.name, Path(self.get_ext_fullpath(ext.name)))


setup(
    name=NAME,
    version='0.2.0',
    description='Controls parallel platforms and serial arms, from a pose target to servo pulses',
    long_description=(Path(__file__).resolve().parent / 'README.md').read_text(encoding='utf-8'),
    long_description_content_type='text/markdown',
    keywords='robotics ROS 2 hexapod Stewart platform 6-DOF arm kinematics servo',
    classifiers=[
        'Intended Audience :: Education',
        'Intended Audience :: Science/Research',
        'Operating System :: POSIX :: Linux',
        'Programming Language :: C',
        'Programming Language :: Python :: 3',
        'Topic :: Scientific/Engineering',
        'Typing :: Typed',
    ],
    license='Apache-2.0',
    python_requires='>=3.10',
    packages=find_packages(include=[pattern for r in PACKAGES for pattern in (r, f'{r}.*')]),
    ext_modules=[
        Extension(name, library.files('*.c'), depends=library.files('*.h'), py_limited_api=True)
        for name, library in LIBRARIES.items()
    ],
    cmdclass={'build_ext': BuildLibraries},
    options={'bdist_wheel': {'py_limited_api': 'cp310'}},
    package_data={'': ['py.typed', '*.pyi'], 'hexarm': ['*.xml', 'panel/page/*']},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (f'share/{NAME}', ['package.xml']),
        (f'share/{NAME}/config', sorted(str(f) for f in Path('config').iterdir())),
        (f'share/{NAME}/launch', sorted(str(f) for f in Path('launch').glob('*.launch.py'))),
        (f'share/{NAME}/viewers', sorted(str(f) for f in Path('viewers').iterdir())),
    ],
    install_requires=[
        'numpy>=1.26',
        'pyserial>=3.5',
        'PyYAML>=6.0',
        'ruckig>=0.14',
        'scipy>=1.11',  # analysis and calibration
    ],
    extras_require={
        # ROS 2 Jazzy from wheels; a system installation brings these three itself.
        'ros': [
            'ros-jazzy-rclpy>=7.1',
            'ros-jazzy-common-interfaces>=5.3',
            'ros-jazzy-rmw-fastrtps-cpp>=8.4',
        ],
        'gamepad': ['evdev>=1.6; sys_platform == "linux"'],
        'plot': ['matplotlib>=3.8'],
        'physics': ['mujoco>=3.2', 'matplotlib>=3.8', 'pillow>=10'],
        'record': ['mcap>=1.6', 'mcap-ros2-support>=0.5', 'matplotlib>=3.8'],
        'panel': ['viser>=1.1,<1.2'],  # panel/nodes/web_server.py reaches into it
        'meshes': ['trimesh>=4', 'pycollada>=0.8'],  # of a URDF: hexarm import
        'foxglove': ['foxglove-sdk>=0.10'],
        'terminal': ['rich>=13', 'argcomplete>=3'],
        'docs': ['mkdocs-material>=9.5', 'mkdocstrings-python>=1.10'],  # make docs
        # Libraries that `make bench` compares with: docs/performance.md.
        'bench': [
            'reachy-mini-rust-kinematics>=1.0',
            'pin>=3.0',
            'roboticstoolbox-python>=1.2',
            'ikpy>=3.4',
            'mink>=1.0',
            'daqp>=0.5',
            'EAIK>=1.2',
            'pytracik>=0.0.3',
        ],
        'test': [
            'pytest>=8.2',
            'pytest-xdist>=3.6',
            'coverage>=7.4',  # which tests run which line: bench/mutants/tests.py
            'pytest-cov>=5',
            'hypothesis>=6.100',
            'jsonschema>=4',
            'mypy>=1.11',
            'playwright>=1.45',  # drives the system's Chromium, for the panel's page
            'ruff>=0.6',
            'foxglove-sdk>=0.10',
            'rosbags>=0.10',  # reads our recordings independently
            'types-PyYAML>=6.0',
            'colcon-core>=0.18',
            'colcon-ros>=0.5',
            'pin>=3.0',  # Pinocchio: the arms' poses and Jacobians against another's
            'setuptools>=70.1,<80',  # builds wheels by itself, and still what colcon calls
        ],
    },
    entry_points={
        'console_scripts': [
            'hexarm = hexarm.cli.main:main',
            'hexapod_trajectory = hexarm.nodes:trajectory',
            'hexapod_ik = hexarm.nodes:ik',
            'hexapod_pose = hexarm.nodes:pose',
            'arm_trajectory = hexarm.nodes:arm_trajectory',
            'arm_ik = hexarm.nodes:arm_ik',
            'arm_pose = hexarm.nodes:arm_pose',
            'joy_teleop = hexarm.nodes:joy_teleop',
            'keyboard_teleop = hexarm.nodes:keyboard_teleop',
            'serial_bridge = hexarm.nodes:serial_bridge',
            'fake_hardware = hexarm.nodes:fake_hardware',
            'hexarm_machine = hexarm.nodes:machine',
            'hexarm_gamepad = hexarm.nodes:gamepad',
            'hexarm_panel = hexarm.nodes:panel',
        ],
    },
)
