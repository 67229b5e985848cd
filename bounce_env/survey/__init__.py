"""What random balls find in a scene: traps, endless scoring, targets that nothing reaches."""

from bounce_env.survey.findings import Finding, findings
from bounce_env.survey.run import Survey, survey
from bounce_env.survey.starts import NoRoomError

__all__ = ["Finding", "NoRoomError", "Survey", "findings", "survey"]
