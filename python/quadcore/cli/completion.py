"""``quadcore completion``: complete commands and options with the Tab key."""

from __future__ import annotations

import argparse
from typing import Any

from ..support.optional_packages import require_package
from .parser import add_command

_SHELLS = ("bash", "zsh", "fish")


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "completion",
        "Print the shell code that completes quadcore's commands and options.",
        print_code,
        """
        quadcore completion bash >> ~/.bashrc
        quadcore completion zsh >> ~/.zshrc
        quadcore completion fish > ~/.config/fish/completions/quadcore.fish
        """,
    )
    parser.add_argument("shell", metavar="SHELL", choices=_SHELLS, help=", ".join(_SHELLS))


def print_code(arguments: argparse.Namespace) -> None:
    """Print the code."""
    with require_package("completion", "argcomplete", "completion"):
        from argcomplete.shell_integration import shellcode

    # The bash code of argcomplete also works in zsh.
    shell = "fish" if arguments.shell == "fish" else "bash"
    if arguments.shell == "zsh":
        print("autoload -U +X compinit && compinit")
    print(shellcode(["quadcore"], shell=shell))


def complete(parser: argparse.ArgumentParser) -> None:
    """Answer a completion request of the shell, and end the process."""
    with require_package("completion", "argcomplete", "completion"):
        import argcomplete

    argcomplete.autocomplete(parser)
