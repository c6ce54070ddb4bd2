"""Who does not answer costs the others little, and is asked again at once when the line is back."""

from datetime import UTC, datetime, timedelta

from app.modbus.silences import LONGEST_REST, Silences

NOON = datetime(2027, 6, 21, 12, tzinfo=UTC)
WAITED = timedelta(seconds=0.3)


def at(seconds: float) -> datetime:
    return NOON + timedelta(seconds=seconds)


def test_one_silent_device_rests_after_three_times_and_longer_each_time() -> None:
    silences = Silences()
    rests = []
    for _ in range(8):
        silences.heard("other")
        silences.unheard("it", NOON, WAITED)
        rests.append(next(ms for ms in range(0, 6001, 10) if not silences.resting("it", at(ms / 1000))))
    assert rests[:5] == [0, 0, 250, 500, 1000]
    assert rests[-1] == LONGEST_REST.total_seconds() * 1000
    assert not silences.resting("other", NOON)


def test_of_several_silent_devices_one_at_a_time_is_asked() -> None:
    silences = Silences()
    for device in ("first", "second", "third"):
        silences.unheard(device, NOON, WAITED)
        silences.heard("other")
    assert not silences.all_silent
    assert not silences.resting("first", NOON), "one silence of the only silent device is nothing"
    silences.unheard("first", at(1.0), WAITED)
    silences.heard("other")
    assert silences.resting("second", at(2.1)), "so shortly after another nobody waits for it"
    assert not silences.resting("second", at(2.3))


def test_when_one_of_them_answers_all_others_are_asked_at_once() -> None:
    silences = Silences()
    for _ in range(8):
        for device in ("first", "second", "third"):
            silences.unheard(device, NOON, WAITED)
            silences.heard("other")
    assert silences.resting("third", at(3.9))
    silences.heard("first")
    assert not silences.resting("second", NOON)
    assert not silences.resting("third", NOON)


def test_a_whole_line_is_silent_until_anybody_answers() -> None:
    silences = Silences()
    for _ in range(4):
        silences.unheard("first", NOON, WAITED)
    assert not silences.all_silent, "that is one device"
    silences.unheard("second", NOON, WAITED)
    assert silences.all_silent
    assert not silences.resting("first", NOON), "nobody else loses by its being asked"
    silences.heard("third")
    assert not silences.all_silent
    silences.unheard("first", NOON, WAITED)
    silences.unheard("second", NOON, WAITED)
    silences.forget("first")
    assert not silences.all_silent, "who is gone is forgotten"
