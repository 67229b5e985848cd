"""What random balls find in a scene: traps, endless scoring, targets that nothing reaches."""

from bounce_env.scenecheck.findings import Finding, findings
from bounce_env.scenecheck.run import Survey, survey
from bounce_env.scenecheck.starts import NoRoomError

__all__ = ["Finding", "NoRoomError", "Survey", "findings", "survey"]
