"""`python -m bounce_env`; see `bounce_env.commands`."""

import sys

from bounce_env.commands import main

if __name__ == "__main__":
    sys.exit(main())
