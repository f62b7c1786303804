"""Registers the environments with Gymnasium, which calls `register` by the package's entry point."""

SCORE = "onetwo/Score-v0"


def register() -> None:
    """Registers `onetwo/Score-v0`, once."""
    from gymnasium.envs import registration

    if SCORE not in registration.registry:
        registration.register(SCORE, entry_point="onetwo.env:ScoreEnv")
