"""The SunSpec server, read and written by pysunspec2 and by hand."""

import asyncio
import contextlib
import socket
from collections.abc import AsyncIterator
from dataclasses import dataclass, replace
from pathlib import Path
from struct import pack, unpack
from typing import Any

import pytest
import sunspec2.modbus.client as sunspec
from sunspec2.modbus.modbus import ModbusClientException

from app.base.clock import SystemClock
from app.base.settings import Settings
from app.drives.connections.buses import Buses
from app.drives.connections.met_station import met_reader
from app.drives.drive import Drive
from app.drives.profile import PROFILES
from app.gateway.sunspec import SunSpecTcp
from app.gateway.sunspec_device import SunSpecDevice
from app.gateway.sunspec_map import BASE, END, map_table, sunspec_map
from app.link.messages import ConfigureTracker, ReleaseControl, RequestControl
from app.link.weather_orders import ReportWeather
from app.machine.drive_factory import DriveFactory
from app.modbus.errors import DriveRefused
from app.simulation.faults import Fault, FaultKind
from app.simulation.simulated import SimulatedDrive
from app.tracker.commands.commands import Jog, Move, SelectMode, Stop
from app.tracker.memory.memory import MetStation
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import (
    DriveConfig,
    DriveKind,
    MountConfig,
    MountKind,
    Orientation,
    TrackerConfig,
)
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.values.mode import Mode
from app.tracker.values.motion import DriveCommand, Position
from app.tracker.weather.weather import Weather
from tests.captured_logs import capture_logs
from tests.fault_result import VIRTUAL, FaultResult
from tests.gateway.rigs import tracker
from tests.patience import PATIENCE_S, eventually
from tests.patient_loop import LoopClock
from tests.site.plant import Plant, make_plant, settle

NOTHING = 0x8000_0000
FIRST_TRACKER = BASE + 70 + 28
EL_CTL, AZ_CTL, CTL = FIRST_TRACKER + 16, FIRST_TRACKER + 18, FIRST_TRACKER + 20
GLOBAL_CTL = BASE + 70 + 24


@dataclass
class Scada:
    """A plant's control system in front of the server."""

    plant: Plant
    server: SunSpecTcp

    async def scan(self) -> Any:
        return await asyncio.to_thread(self._scan)

    def _scan(self) -> Any:
        device = sunspec.SunSpecModbusClientDeviceTCP(1, "127.0.0.1", self.server.port, timeout=PATIENCE_S)
        device.scan()
        device.connect()
        return device

    async def ask(self, request: bytes, unit: int = 1) -> bytes:
        """Send one request and return the body of the reply."""
        reader, writer = await asyncio.open_connection("127.0.0.1", self.server.port)
        writer.write(pack(">HHHB", 7, 0, len(request) + 1, unit) + request)
        transaction, _, length, _ = unpack(">HHHB", await reader.readexactly(7))
        body = await reader.readexactly(length - 1)
        writer.close()
        await writer.wait_closed()
        assert transaction == 7
        return body

    async def read(self, address: int, count: int) -> list[int]:
        body = await self.ask(pack(">BHH", 3, address, count))
        assert body[0] == 3, body
        return list(unpack(f">{count}H", body[2:]))

    async def write(self, address: int, *words: int) -> bytes:
        head = pack(">BHHB", 16, address, len(words), 2 * len(words))
        return await self.ask(head + pack(f">{len(words)}H", *words))

    def journal(self) -> list[tuple[EventKind, str, str]]:
        return [(event.kind, event.actor, event.message) for event in self.plant.events]


@contextlib.asynccontextmanager
async def scada(*trackers: str, write_hosts: str = "127.0.0.1") -> AsyncIterator[Scada]:
    plant = make_plant(trackers=tuple(map(tracker, trackers or ("T1",))))
    await plant.start()
    wanted = Settings(sunspec_port=0, sunspec_write_hosts=write_hosts)  # type: ignore[arg-type]
    clock = LoopClock()
    device = SunSpecDevice(plant.site, clock, write_hosts=wanted.sunspec_write_hosts)
    server = SunSpecTcp(device, clock, wanted)
    serving = [asyncio.create_task(work) for work in (server.run(), device.follow())]
    await eventually(lambda: server.port)
    try:
        yield Scada(plant, server)
    finally:
        for task in serving:
            task.cancel()
        await asyncio.gather(*serving, return_exceptions=True)
        await plant.close()


@pytest.fixture
async def system() -> AsyncIterator[Scada]:
    async with scada() as found:
        yield found


def two(words: list[int]) -> int:
    return words[0] << 16 | words[1]


def packed(angle_deg: float) -> tuple[int, int]:
    raw = round(angle_deg * 1000) & 0xFFFF_FFFF
    return raw >> 16, raw & 0xFFFF


async def test_pysunspec_scans_the_models_of_every_tracker() -> None:
    async with scada("T1", "T2") as system:
        await system.plant.commission("T2")
        device = await system.scan()
        try:
            assert device.base_addr == BASE
            assert [name for name in device.models if isinstance(name, int)] == [1, 601, 305]
            assert all(not model[0].error_info for model in device.models.values())
            controller = device.tracker_controller[0]
            assert (controller.L.value, controller.N.value) == (26 + 22 * 2, 2)
            second = controller.tracker[1]
            measured = system.plant.tracker("T2").measured
            assert measured is not None
            assert second.AzPos.cvalue == pytest.approx(measured.azimuth_deg, abs=5e-4)
            assert second.ElPos.cvalue == pytest.approx(measured.elevation_deg, abs=5e-4)
            assert second.Id.value == "Tracker T2"
            assert (controller.DtLoc.value, controller.Day.value) == ("20270621", 172)
            place = device.location[0]
            assert (place.Lat.cvalue, place.Long.cvalue) == (41.2867, 36.33)
            assert device.common[0].Mn.value == "Heliopanel"
        finally:
            device.disconnect()


async def test_pysunspec_writes_targets_and_control_and_is_refused_what_is_out_of_range(
    system: Scada,
) -> None:
    await system.plant.commission()
    device = await system.scan()
    controller = device.tracker_controller[0]

    def write(**values: float) -> None:
        for name, value in values.items():
            group = controller if name.startswith("Glbl") else controller.tracker[0]
            point = getattr(group, name)
            point.cvalue = value
        controller.write()

    try:
        await asyncio.to_thread(write, ElCtl=40.0, AzCtl=170.0, Ctl=1)
        assert system.plant.tracker().activity is ActivityName.MOVING
        for wrong in ({"ElCtl": 90.5}, {"AzCtl": 361.0}, {"GlblElCtl": -91.0}, {"Ctl": 3}, {"GlblCtl": 7}):
            with pytest.raises(ModbusClientException, match="3"):
                await asyncio.to_thread(lambda values=wrong: write(**values))
        await asyncio.to_thread(write, GlblElCtl=30.0, GlblAzCtl=120.0, GlblCtl=1)
        await asyncio.to_thread(controller.read)
        assert (controller.tracker[0].ElCtl.cvalue, controller.tracker[0].AzCtl.cvalue) == (30.0, 120.0)
        assert controller.GlblAzCtl.cvalue == 120.0
    finally:
        device.disconnect()
    told = system.journal()
    going = "Going to azimuth 120.0, elevation 30.0 degrees."
    assert (EventKind.MOVE_STARTED, "sunspec 127.0.0.1", going) in told
    refused = [message for kind, _, message in told if kind is EventKind.REMOTE_REFUSED]
    assert "90.5 was written to ElCtl over SunSpec; it must lie between -90 and 90." in refused
    assert "-91 was written to GlblElCtl over SunSpec; it must lie between -90 and 90." in refused
    assert len(refused) == 5


async def test_a_refused_target_is_not_kept_and_manual_control_goes_on(system: Scada) -> None:
    plant = system.plant
    await plant.commission()
    await system.write(EL_CTL, *packed(30.0), *packed(140.0), 1)
    assert await system.write(EL_CTL, *packed(-20.0)) == bytes((0x90, 3)), "beyond the soft limits"
    assert two(await system.read(EL_CTL, 2)) == 30_000
    assert plant.tracker().activity is ActivityName.MOVING, "the move before it goes on"
    assert (await system.write(AZ_CTL, *packed(150.0)))[0] == 16
    await plant.until(lambda seen: seen.in_position and seen.activity is ActivityName.HOLDING)
    measured = plant.tracker().measured
    assert measured is not None
    assert (measured.azimuth_deg, measured.elevation_deg) == pytest.approx((150.0, 30.0), abs=0.05)


async def test_after_a_target_for_all_a_tracker_keeps_the_angle_that_is_not_written_anew(
    system: Scada,
) -> None:
    await system.plant.commission()
    await system.write(BASE + 70 + 20, *packed(30.0), *packed(120.0), 1)
    await system.write(EL_CTL, *packed(35.0))
    moves = [message for kind, _, message in system.journal() if kind is EventKind.MOVE_STARTED]
    assert moves[-1] == "Going to azimuth 120.0, elevation 35.0 degrees."
    written = "GlblElCtl = 30, GlblAzCtl = 120, GlblCtl = 1 was written over SunSpec."
    assert written in [message for _, _, message in system.journal()]


async def test_what_is_not_known_is_not_implemented_and_never_an_old_value(system: Scada) -> None:
    await system.plant.commission()
    drive = system.plant.drives["T1"]
    assert two(await system.read(FIRST_TRACKER + 14, 2)) != NOTHING
    assert isinstance(drive, SimulatedDrive)
    drive.inject(Fault(FaultKind.SILENCE))
    await system.plant.forward(seconds=1)
    assert two(await system.read(FIRST_TRACKER + 12, 2)) == NOTHING
    assert two(await system.read(FIRST_TRACKER + 14, 2)) == NOTHING
    assert two(await system.read(EL_CTL, 2)) == NOTHING, "nothing was written yet"
    assert await system.read(FIRST_TRACKER + 21, 1) == [1], "the set point is not known to be reached"


async def test_weather_brings_model_307_and_stale_weather_is_not_told(system: Scada) -> None:
    before = await system.read(BASE + 70 + 2 + 48 + 38, 2)
    assert before == list(END)
    await system.plant.ask(ReportWeather(Weather(wind_mps=7.4, temperature_degc=-3.24)))
    device = await system.scan()
    try:
        met = device.base_met[0]
        assert (met.WndSpd.cvalue, met.TmpAmb.cvalue, met.RH.cvalue) == (7, -3.2, None)
        reader = met_reader(Buses(LoopClock()), MetStation("127.0.0.1", system.server.port))
        assert await reader.read() == (Weather(wind_mps=7.0, temperature_degc=-3.2), ())
        await reader.close()
        await system.plant.forward(seconds=301)
        await asyncio.to_thread(met.read)
        assert (met.WndSpd.cvalue, met.TmpAmb.cvalue) == (None, None)
    finally:
        device.disconnect()


async def test_calibrate_homes_and_goes_back_to_automatic_although_an_order_is_refused(system: Scada) -> None:
    plant = system.plant
    await _tracking(system)
    assert await system.read(CTL, 1) == [0]
    assert (await system.write(CTL, 2))[0] == 16
    await settle()
    assert await system.read(CTL, 1) == [2]
    await plant.until(lambda seen: seen.activity is ActivityName.HOMING)
    assert await system.write(EL_CTL, *packed(-20.0), *packed(140.0), 1) == bytes((0x90, 3))
    await plant.until(lambda seen: seen.activity is ActivityName.TRACKING)
    await settle()
    assert await system.read(CTL, 1) == [0]


async def test_a_new_target_is_gone_to_only_while_this_door_has_manual_control(system: Scada) -> None:
    plant = system.plant
    await plant.commission()
    await system.write(EL_CTL, *packed(30.0))
    assert plant.tracker().activity is ActivityName.HOLDING, "a target alone moves nothing"
    await system.write(CTL, 1)
    await plant.until(lambda seen: seen.in_position and seen.activity is ActivityName.HOLDING)
    await system.write(EL_CTL, *packed(33.0))
    assert plant.tracker().activity is ActivityName.MOVING
    await plant.ask(Stop())
    await plant.until(lambda seen: seen.activity is ActivityName.HOLDING)
    await settle()
    await system.write(EL_CTL, *packed(36.0))
    assert plant.tracker().activity is ActivityName.HOLDING, "somebody else stopped it"
    assert (await system.write(EL_CTL, *packed(36.0), *packed(120.0), 1))[0] == 16
    assert plant.tracker().activity is ActivityName.MOVING, "and is overruled by the next order"


async def test_calibrate_does_not_take_the_tracker_out_of_the_hands_that_move_it(system: Scada) -> None:
    plant = system.plant
    await plant.commission()
    await plant.ask(Jog("press", Axis.AZIMUTH, 1))
    await plant.forward(seconds=0.1)
    assert await system.write(CTL, 2) == bytes((0x90, 6))
    assert plant.tracker().activity is ActivityName.JOGGING
    assert "is being jogged" in system.journal()[-1][2]
    await plant.forward(seconds=60)
    assert plant.tracker().activity is ActivityName.HOLDING
    assert plant.tracker().homed, "it was not begun afterwards either"


async def test_a_stop_by_somebody_else_ends_a_calibration_for_good(system: Scada) -> None:
    plant = system.plant
    await _tracking(system)
    await system.write(CTL, 2)
    await plant.until(lambda seen: seen.activity is ActivityName.HOMING)
    await plant.ask(Stop())
    await plant.forward(seconds=60)
    assert plant.tracker().activity is ActivityName.HOLDING
    assert not plant.tracker().tracking_on
    assert any("The calibration was aborted" in message for _, _, message in system.journal())
    assert await system.read(CTL, 1) == [1]


async def test_all_trackers_do_what_they_can_and_only_then_it_fails() -> None:
    async with scada("T1", "T2") as system:
        await system.plant.commission("T2")
        words = (*packed(30.0), *packed(100.0), 1)
        assert (await system.write(BASE + 70 + 20, *words))[0] == 16
        assert system.plant.tracker("T2").activity is ActivityName.MOVING
        assert system.plant.tracker("T1").activity is ActivityName.HOLDING
        assert any(
            kind is EventKind.REMOTE_REFUSED and "Tracker T1 is not homed" in message
            for kind, _, message in system.journal()
        )


@pytest.mark.fault(92)
@pytest.mark.parametrize("words", [(*packed(45.0), *packed(120.0), 1), (*packed(45.0), *packed(120.0))])
async def test_the_same_value_written_in_cycles_is_journalled_and_ordered_once(
    system: Scada, words: tuple[int, ...], fault: FaultResult
) -> None:
    await system.plant.commission()
    before = len(system.journal())
    for _ in range(30):
        assert (await system.write(EL_CTL, *words))[0] == 16
        await system.plant.forward(seconds=1)
    kinds = [kind for kind, _, _ in system.journal()[before:]]
    assert kinds.count(EventKind.REMOTE_WRITTEN) == 1
    told = next(text for kind, _, text in system.journal()[before:] if kind is EventKind.REMOTE_WRITTEN)
    assert kinds.count(EventKind.MOVE_STARTED) == (1 if len(words) == 5 else 0)
    assert (await system.write(EL_CTL, *packed(46.0)))[0] == 16
    kinds = [kind for kind, _, _ in system.journal()[before:]]
    assert kinds.count(EventKind.REMOTE_WRITTEN) == 2, "a change is journalled"
    assert kinds.count(EventKind.MOVE_STARTED) == (2 if len(words) == 5 else 0)
    orders = (await system.plant.site.metrics()).orders
    assert orders >= (30 if len(words) == 5 else 0), "every write is counted"
    fault.prevented("a value that is written again changes nothing")
    if len(words) == 5:
        fault.shows(f"once: {told}")
    fault.recovers("automatic: the first other value is journalled and ordered")


async def test_a_refusal_in_cycles_is_journalled_once_in_a_while_with_its_reasons(system: Scada) -> None:
    for _ in range(30):
        assert await system.write(CTL, 0) == bytes((0x90, 6))
        await system.plant.forward(seconds=1)
    refused = [one for one in system.journal() if one[0] is EventKind.REMOTE_REFUSED]
    assert [actor for _, actor, _ in refused] == ["sunspec 127.0.0.1"]
    assert all(why in refused[0][2] for why in ("is not homed", "no location"))
    await system.plant.forward(seconds=61)
    assert await system.write(CTL, 0) == bytes((0x90, 6))
    assert sum(kind is EventKind.REMOTE_REFUSED for kind, _, _ in system.journal()) == 2
    assert await system.write(CTL, 1) == bytes((0x90, 3)), "no target was written"


@pytest.mark.parametrize("write_hosts", ["", "10.0.0.0/8, serial"])
async def test_other_hosts_may_only_read(write_hosts: str) -> None:
    async with scada(write_hosts=write_hosts) as system:
        await system.plant.commission()
        for _ in range(5):
            assert await system.write(EL_CTL, *packed(45.0)) == bytes((0x90, 1))
        refused = [message for kind, _, message in system.journal() if kind is EventKind.REMOTE_REFUSED]
        assert len(refused) == 1, "a host that goes on does not fill the journal"
        assert "only the hosts in HELIOPANEL_SUNSPEC_WRITE_HOSTS may" in refused[0]
        assert two(await system.read(EL_CTL, 2)) == NOTHING


@pytest.mark.fault(89)
async def test_sixteen_idle_connections_do_not_lock_the_control_system_out(
    system: Scada, fault: FaultResult
) -> None:
    idle = [await asyncio.open_connection("127.0.0.1", system.server.port) for _ in range(16)]
    await eventually(lambda: system.server.metrics().clients == 16)
    loop = asyncio.get_running_loop()
    began_s = loop.time()
    with capture_logs() as logged:
        assert await system.read(BASE, 2) == [0x5375, 0x6E53]
    answered_s = loop.time() - began_s
    assert answered_s < 1.0
    assert [(line["event"], line["host"]) for line in logged] == [("modbus_client_gave_way", "127.0.0.1")]
    fault.noticed(answered_s, VIRTUAL)
    fault.shows_nothing("the new connection is answered; the log names the host that gave way")
    for _ in range(2):
        assert await system.read(BASE, 2) == [0x5375, 0x6E53]
    assert await idle[0][0].read() == b"", "the longest idle gave way"
    fault.recovers("automatic: at every new connection")
    for _, writer in idle:
        writer.close()


@pytest.mark.fault(88)
async def test_a_client_that_reads_no_replies_keeps_neither_ticks_nor_stops_from_their_turn(
    system: Scada, fault: FaultResult
) -> None:
    await system.plant.commission()
    read = pack(">HHHBBHH", 7, 0, 6, 1, 3, BASE, 125)
    with socket.socket() as flood:
        flood.setblocking(False)
        loop = asyncio.get_running_loop()
        await loop.sock_connect(flood, ("127.0.0.1", system.server.port))
        sending = asyncio.create_task(loop.sock_sendall(flood, read * 100_000))
        await eventually(lambda: system.server.metrics().clients == 1)
        before = system.plant.tracker().tick
        await system.plant.ask(Move(Orientation(150.0, 40.0)))
        await system.plant.forward(seconds=5)
        assert system.plant.tracker().tick - before >= 50
        await system.plant.ask(Stop())
        assert system.plant.tracker().activity is ActivityName.STOPPING
        sending.cancel()
        await asyncio.gather(sending, return_exceptions=True)
    fault.recovers("automatic: ticks and stops keep their turn meanwhile")


REFUSED = {
    "before the map": (pack(">BHH", 3, BASE - 1, 2), 2),
    "behind the map": (pack(">BHH", 3, BASE + 70 + 2 + 48 + 38 + 1, 2), 2),
    "coils": (pack(">BHH", 1, BASE, 1), 2),
    "a coil": (pack(">BHH", 5, BASE, 0xFF00), 2),
    "what can only be read": (pack(">BHH", 6, BASE + 70 + 11, 5), 2),
    "the unit id": (pack(">BHH", 6, BASE + 68, 9), 2),
    "half of an angle": (pack(">BHH", 6, EL_CTL, 1), 3),
    "an angle and half of the next": (pack(">BHHB3H", 16, EL_CTL, 3, 6, 0, 1000, 0), 3),
    "a span into what can only be read": (pack(">BHHB2H", 16, CTL, 2, 4, 1, 0), 2),
    "nothing": (pack(">BHHBI", 16, EL_CTL, 2, 4, NOTHING), 3),
    "too many": (pack(">BHH", 3, BASE, 126), 3),
    "a function that is not there": (bytes((43, 14, 1, 0)), 1),
}


async def test_what_cannot_be_done_is_answered_with_its_exception(system: Scada) -> None:
    for name, (request, code) in REFUSED.items():
        assert await system.ask(request) == bytes((request[0] | 0x80, code)), name
    both = pack(">BHHHHB2H", 23, EL_CTL, 2, EL_CTL, 2, 4, *packed(12.5))
    assert await system.ask(both) == bytes((23, 4)) + pack(">2H", *packed(12.5)), "the write comes first"


async def test_the_type_is_that_of_the_mounts() -> None:
    async with scada("T1", "T2") as system:
        for tracker_id, expected in (("T1", 99), ("T2", 4)):
            config = system.plant.site.model.tracker(tracker_id).config
            mount = MountConfig(MountKind.VERTICAL_SINGLE_AXIS)
            await system.plant.ask(ConfigureTracker(replace(config, mount=mount)))
            await system.plant.forward(seconds=0.2)
            assert await system.read(BASE + 70 + 10, 1) == [expected]


def second_tracker(folder: Path, port: int, number: int) -> Drive:
    """A drive whose profile is the shipped one for another tracker of the controller."""
    (folder / "profiles").mkdir(exist_ok=True)
    text = (PROFILES / "sunspec-601.toml").read_text(encoding="utf-8")
    text = text.replace('"sunspec-601"', '"second"').replace("tracker = 1", f"tracker = {number}")
    (folder / "profiles" / "second.toml").write_text(text, encoding="utf-8")
    wiring = DriveConfig(DriveKind.MODBUS_TCP, profile="second", port=port)
    return DriveFactory(SystemClock(), folder).make(TrackerConfig("X", "Another controller", drive=wiring))


async def test_our_own_sunspec_drive_moves_the_tracker_that_its_profile_says(tmp_path: Path) -> None:
    async with scada("T1", "T2") as system:
        await system.plant.commission("T1")
        await system.plant.commission("T2")
        before = system.plant.tracker("T1").measured
        drive = second_tracker(tmp_path, system.server.port, 2)
        for azimuth_deg in (100.0, 120.0):
            await drive.read()
            await drive.write(DriveCommand(Position(azimuth_deg, 6.0), Position(30.0, 4.0)))
            await system.plant.forward(seconds=40)
            seen = await drive.read()
            assert (seen.azimuth.position_deg, seen.elevation.position_deg) == (azimuth_deg, 30.0)
        await drive.close()
        assert system.plant.tracker("T1").measured == before, "the first was not touched"
        drive = second_tracker(tmp_path, system.server.port, 3)
        with pytest.raises(DriveRefused, match="has 2 trackers, but profile second needs number 3"):
            await drive.read()
        await drive.close()


def test_the_document_has_the_map_of_the_code() -> None:
    document = (Path(__file__).parents[2] / "docs" / "integrate" / "sunspec.md").read_text()
    assert map_table(sunspec_map(("T1",), weather=True)) in document


async def _tracking(system: Scada) -> None:
    plant = system.plant
    await plant.commission()
    await plant.ask(SelectMode(Mode.DUAL))
    await plant.ask(ReleaseControl("T1"))
    assert (await system.write(CTL, 0))[0] == 16
    await plant.until(lambda seen: seen.in_position and seen.activity is ActivityName.TRACKING)


async def test_what_a_person_has_control_of_is_not_moved_over_sunspec(system: Scada) -> None:
    plant = system.plant
    await plant.commission()
    await plant.ask(RequestControl(("T1",)))
    assert await system.write(EL_CTL, *packed(30.0), *packed(140.0), 1) == bytes((0x90, 6))
    assert await system.write(BASE + 70 + 20, *packed(30.0), *packed(120.0), 1) == bytes((0x90, 6))
    assert await system.write(CTL, 2) == bytes((0x90, 6)), "it is not even stopped for a calibration"
    assert plant.tracker().activity is ActivityName.HOLDING
    assert "technician has control of Tracker" in system.journal()[-1][2]
    await plant.ask(ReleaseControl("T1"))
    assert (await system.write(EL_CTL, *packed(30.0), *packed(140.0), 1))[0] == 16
    assert plant.tracker().control.holder == "SunSpec"
