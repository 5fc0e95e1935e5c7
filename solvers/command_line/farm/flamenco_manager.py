"""Talk to a Flamenco Manager through its HTTP interface, which Flamenco documents as OpenAPI.

This is the only module that opens an HTTP connection, and only to the address that the user
gives.
"""

import json
import re
from http.client import HTTPException
from typing import Any, NamedTuple
from urllib.error import HTTPError, URLError
from urllib.parse import quote, urlsplit
from urllib.request import HTTPRedirectHandler, ProxyHandler, Request, build_opener

from ...errors import InvalidSettingError, MocapAssistError
from ...faults import escaped
from ...json_text import parse_json

TIMEOUT_S = 10.0
"""Seconds that a Manager may be silent. It bounds the wait for one that hangs."""
MAX_ANSWER_BYTES = 1_000_000
"""Bytes of an answer. It guards memory against servers of other kinds: job types have 5,000."""
MAX_MESSAGE_LETTERS = 300
"""Letters of a Manager's message that are shown. It bounds the sentence in the status bar."""
IDENTIFIER = re.compile(r"[0-9a-f-]{1,64}")
"""Identifier of a job: Flamenco documents a UUID. It guards the address that is shown."""
VERSION = "3"
"""The version of Flamenco whose interface this is."""
OK, NOT_FOUND, OUTDATED = 200, 404, 412
REDIRECTS, CLIENT_ERRORS = range(300, 400), range(400, 500)
"""Status codes of HTTP, as the interface uses them."""


class KnownJobType(NamedTuple):
    """A job type as a Manager knows it."""

    keys: frozenset[str]
    """Names of its settings; empty for one without a name."""
    etag: str
    """Hash of the job type, by which the Manager refuses a job for another version of it."""


class FlamencoManager:
    """A Flamenco Manager at an address, such as http://farm:8080.

    Raises
    ------
    InvalidSettingError
        The address is not one of HTTP.
    """

    def __init__(self, address: str) -> None:
        self.address = _checked_address(address)
        # A Manager is in the studio's network: no proxy of the system.
        self._opener = build_opener(ProxyHandler({}), _NoRedirects())

    def check_version(self) -> None:
        """Check that it is a Flamenco Manager of version 3.

        Raises
        ------
        MocapAssistError
            It is not, or it cannot be reached.
        """
        status, found = self._request("GET", "version")
        version = _text_at(found, "shortversion") or _text_at(found, "version")
        if status != OK or not version:
            raise self._not_flamenco()
        if version.split(".")[0] != VERSION:
            raise MocapAssistError(
                f"{self.address} runs Flamenco {_one_line(version)}, and Mocap Assist needs"
                f" Flamenco {VERSION}. Name another Manager."
            )

    def job_type(self, name: str) -> KnownJobType | None:
        """Return the job type as the Manager knows it; None if it does not."""
        status, found = self._request("GET", f"jobs/type/{quote(name, safe='')}")
        if status == NOT_FOUND and _text_at(found, "message"):
            return None
        if status != OK:
            raise self._refusal(status, found)
        settings = found.get("settings") if isinstance(found, dict) else None
        if not isinstance(settings, list):
            raise self._not_flamenco()
        keys = frozenset(_text_at(each, "key") for each in settings)
        return KnownJobType(keys, _text_at(found, "etag"))

    def submit(self, job: dict[str, Any]) -> str:
        """Submit a job, as the interface describes it; return its identifier."""
        status, found = self._request("POST", "jobs", job)
        if status != OK:
            raise self._refusal(status, found)
        identifier = _text_at(found, "id")
        if not IDENTIFIER.fullmatch(identifier):
            raise self._not_flamenco()
        return identifier

    def _request(self, method: str, path: str, body: Any = None) -> tuple[int, Any]:
        """Return the status and the parsed answer of a request."""
        request = Request(
            f"{self.address}/api/v3/{path}",
            data=None if body is None else json.dumps(body).encode(),
            headers={"Accept": "application/json", "Content-Type": "application/json"},
            method=method,
        )
        was_sent = "" if body is None else " Look at its list of jobs before you try again."
        try:
            try:
                answer = self._opener.open(request, timeout=TIMEOUT_S)
            except HTTPError as error:
                answer = error
            with answer:
                if answer.status in REDIRECTS:
                    raise self._redirect_error(answer.headers.get("Location", ""))
                content = answer.read(MAX_ANSWER_BYTES + 1)
        except HTTPException:
            raise self._not_flamenco() from None
        except OSError as error:  # URLError is one.
            reason = error.reason if isinstance(error, URLError) else error
            if isinstance(reason, TimeoutError):
                raise MocapAssistError(
                    f"The Flamenco Manager at {self.address} did not answer within"
                    f" {TIMEOUT_S:g} seconds.{was_sent or ' Try again later.'}"
                ) from None
            raise MocapAssistError(
                f"No Flamenco Manager can be reached at {self.address}"
                f" ({_one_line(getattr(reason, 'strerror', None) or str(reason))})."
                f"{was_sent or ' Start it, or correct the address.'}"
            ) from None
        return answer.status, self._parsed(content)

    def _parsed(self, content: bytes) -> Any:
        if len(content) > MAX_ANSWER_BYTES:
            raise self._not_flamenco()
        try:
            return parse_json(content)
        except ValueError:
            raise self._not_flamenco() from None

    def _refusal(self, status: int, answer: Any) -> MocapAssistError:
        message = _one_line(_text_at(answer, "message") or f"status {status}").rstrip(".")
        if status in CLIENT_ERRORS and status != OUTDATED:
            return InvalidSettingError(
                f"The Flamenco Manager at {self.address} refuses the job: {message}."
            )
        return MocapAssistError(
            f"The Flamenco Manager at {self.address} cannot take the job now: {message}."
            " Try again."
        )

    def _not_flamenco(self) -> MocapAssistError:
        return MocapAssistError(
            f"{self.address} answers, but not as a Flamenco Manager. Correct the address."
        )

    def _redirect_error(self, location: str) -> MocapAssistError:
        return MocapAssistError(
            f"{self.address} redirects to {_one_line(location)}, where nothing was sent. If"
            " that is your Flamenco Manager, enter its address."
        )


class _NoRedirects(HTTPRedirectHandler):
    """Follow no redirect: a job goes to the address that the user gave, or nowhere."""

    def redirect_request(self, *arguments: Any, **options: Any) -> None:
        """Return no request: the redirect becomes the answer."""


def _checked_address(address: str) -> str:
    """Return an address without a slash at its end."""
    text = address.strip() if "://" in address else f"http://{address.strip()}"
    try:
        parts = urlsplit(text)
        is_valid = parts.scheme in {"http", "https"} and bool(parts.hostname)
        is_valid = is_valid and parts.port != 0 and not (parts.query or parts.fragment)
    except ValueError:  # of the port
        is_valid = False
    if not is_valid or "@" in text or not text.isascii() or " " in text or not address.strip():
        raise InvalidSettingError(
            f"{_one_line(address)!r} is not the address of a Flamenco Manager. Enter one such"
            " as http://farm:8080."
        )
    return text.rstrip("/")


def _text_at(answer: Any, key: str) -> str:
    """Return a text of an answer; empty if it has none."""
    found = answer.get(key) if isinstance(answer, dict) else None
    return found if isinstance(found, str) else ""


def _one_line(text: str) -> str:
    """Return a text of another program in one line."""
    return escaped(" ".join(text.split()))[:MAX_MESSAGE_LETTERS]
