"""Sentences about a live stream: who sends, in which protocol, and what is wrong."""

from ...solvers.recordings.streams import ListenerState

OTHER_BODY = "The stream shows another body, which is ignored."


def state_text(doing: str, state: ListenerState, has_other_body: bool = False) -> str:
    """Return what a recording does, who sends, and what is wrong."""
    issue = OTHER_BODY if has_other_body else issue_text(state)
    return " ".join(filter(None, (doing, sender_text(state), issue)))


def sender_text(state: ListenerState) -> str:
    """Return sender, protocol, rate and number of dropped frames; empty before frames came."""
    if state.protocol is None or not state.counts.frames:
        return ""
    protocol, sender, rate = state.protocol.label, state.sender, round(state.rate)
    text = f"{protocol} from {sender}, {rate} Hz, {state.counts.dropped} dropped."
    if state.n_people < 2 or not state.is_present:
        return text
    return f"{text} {state.n_people} people; person {state.person} is followed."


def issue_text(state: ListenerState) -> str:
    """Return the most important issue of a stream; empty without one."""
    if state.is_silent:
        return "The stream has stopped."
    if state.person and state.n_people and not state.is_present:
        return f"Person {state.person} is not in the stream."
    if state.other:
        return f"{state.other} sends too, and is ignored."
    if state.counts.frames:
        return ""
    if state.counts.why:
        return state.counts.why
    if state.n_refused:
        return f"{state.n_refused} packets came from addresses that are not allowed."
    return ""
