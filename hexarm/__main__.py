"""`python -m hexarm`: the command without an installation."""

import sys

from hexarm.cli.main import main

sys.exit(main())
