#!/usr/bin/env bash
# Makes the virtual environment named by the first argument, with hexarm, ROS 2 Jazzy and all that users need, from
# wheels (second argument: demo), or adds what only tests need (ready).
set -u
environment=$1 what=$2

stop() { echo "hexarm: $1" >&2; exit 1; }

platform="$(uname -s) $(uname -m)"
[ "$platform" = 'Linux x86_64' ] || stop "the ROS 2 wheels exist for x86-64 Linux only, this is $platform: install ROS 2 Jazzy on the system and use 'pip install .' (see docs/installation.md)."

fits='import sys; sys.exit(not (3, 10) <= sys.version_info[:2] <= (3, 13))'
python=''
for candidate in ${PYTHON:-python3 python3.12 python3.11 python3.13 python3.10}; do
  "$candidate" -c "$fits" >/dev/null 2>&1 && { python=$candidate; break; }
done
[ -n "$python" ] || stop "needs Python 3.10 to 3.13, found $(python3 --version 2>&1 || echo none): install one of them, or name it with 'make PYTHON=/path/to/python3.12 demo'."
"$python" -c 'import venv, ensurepip' >/dev/null 2>&1 \
  || stop "$("$python" --version) has no venv module: install it (Debian, Ubuntu: apt install python3-venv) and run make again."

unset LD_LIBRARY_PATH _ROS_WHEELS_BOOTSTRAP_COMPLETE PYTHONPATH AMENT_PREFIX_PATH
log="$environment/install.log"
if [ "$what" = demo ]; then
  echo "Making $environment with $("$python" --version), hexarm and ROS 2 in it, 0.7 GB: a minute or two, once."
  "$python" -m venv --clear "$environment" || stop "could not make the virtual environment $environment."
  extras='ros,plot,physics,panel,meshes,terminal,record'
else
  echo "Adding to $environment what only tests need, 0.7 GB: a minute, once."
  extras='test,docs'
fi
"$environment/bin/python" -m pip install --disable-pip-version-check -e ".[$extras]" >>"$log" 2>&1 \
  || { tail -n 15 "$log" >&2; stop "the installation failed, see above and $log (is there a network?)."; }
touch "$environment/$what"
