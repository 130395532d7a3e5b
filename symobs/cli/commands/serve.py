"""The command `serve`: live answers in a browser."""

from __future__ import annotations

import re

import click

from symobs.cli.shared.common import read_file
from symobs.cli.shared.options import options
from symobs.ground.errors import UsageError


@click.command("serve")
@click.argument("file", required=False)
@click.option(
    "--port",
    type=click.IntRange(0, 65535),
    default=0,
    metavar="N",
    help="Listen there; 0: where it did before.",
)
@click.option("--host", default="127.0.0.1", metavar="NAME", help="127.0.0.1, ::1 or localhost.")
@click.option("--no-browser", is_flag=True, help="Do not open a browser.")
@click.option(
    "--timeout",
    type=click.FloatRange(0, min_open=True),
    default=5.0,
    metavar="SECONDS",
    help="What an answer may take.",
)
@click.option("--memory", type=click.IntRange(100), default=1000, metavar="MB", help="What an answer may use.")
@click.option("--share", metavar="URL", help="Copy links to the page at URL, a public site, instead of this server.")
@click.option("--convention", "convention_name", metavar="NAME", help="Write answers in another convention.")
@options("language")
def command(
    file: str | None,
    port: int,
    host: str,
    no_browser: bool,  # noqa: FBT001 - click's signature
    timeout: float,
    memory: int,
    share: str | None,
    convention_name: str | None,
    language: str | None,
) -> None:
    """Move poles, parameters and entries in a browser, every answer checked; FILE is the problem to begin with."""
    from symobs.applications.live.address import keep_address, known_address  # noqa: PLC0415
    from symobs.applications.live.server import (  # noqa: PLC0415
        HOSTS,
        AnswerBudget,
        Server,
        serve,
    )

    if host not in HOSTS:
        raise UsageError(
            f"{host[:40]!r} is not this machine's own address",
            where="--host",
            repair="leave it out; to look at it from another machine, use an SSH tunnel",
        )
    if share is not None and not re.fullmatch(r"https?://[^\s#\"'<>]+", share):
        raise UsageError(f"{share[:60]!r} is no address", where="--share", repair="write https://…, without #")
    state = ""
    if file is not None or convention_name is not None or language is not None:
        from symobs.applications.live.request import link_of  # noqa: PLC0415 - only with a problem
        from symobs.problem import parse, validate  # noqa: PLC0415

        text = read_file(file) if file is not None else ""
        data = parse(text, file or "problem") if file is not None else {}
        if file is not None:
            validate(data)
        if convention_name is not None:
            from symobs.formula.convention import conventions  # noqa: PLC0415 - only with --convention

            if convention_name not in conventions():
                repair = f"use one of {', '.join(conventions())}"
                raise UsageError(f"{convention_name[:40]!r} is not a convention", where="--convention", repair=repair)
            data = {**data, "convention": convention_name}
        if language is not None:
            from symobs.formula.phrases.languages import language_named  # noqa: PLC0415 - only with --language

            data = {**data, "language": language_named(language, "--language").code}
        state = link_of(data)
    last, token = known_address()
    own = AnswerBudget(timeout, memory), token, share or ""
    try:
        server = Server(host, port or last, *own)
    except OSError as error:
        if port or not last:
            raise UsageError(error.strerror or "cannot listen", where="--port", repair="leave it out") from None
        server = Server(host, 0, *own)  # something else has the port of the last start
    if not last:
        keep_address(server.server_address[1], token)
    url = server.url + (f"&{state}" if state else "")
    click.echo(url)
    if not no_browser:
        import webbrowser  # noqa: PLC0415 - not without one

        webbrowser.open(url)
    serve(server)
