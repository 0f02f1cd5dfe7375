"""A volume written to object storage, as any reader of Zarr finds it there."""

import http.server
import threading

import petroglyph
import pytest


@pytest.fixture
def storage(monkeypatch):
    """Objects by ``BUCKET/KEY`` of a storage on loopback with the bucket ``surveys``."""
    objects = {}

    class Handler(http.server.BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def key(self):
            return self.path.partition("?")[0].lstrip("/")

        def reply(self, status, body=b"", **headers):
            self.send_response(status)
            for name, value in {"Content-Length": str(len(body)), "ETag": '"one"', **headers}.items():
                self.send_header(name, value)
            self.end_headers()
            self.wfile.write(b"" if self.command == "HEAD" else body)

        def do_PUT(self):
            body = self.rfile.read(int(self.headers["Content-Length"]))
            if not self.key().startswith("surveys/"):
                return self.reply(404)
            objects[self.key()] = body
            return self.reply(200)

        def do_DELETE(self):
            objects.pop(self.key(), None)
            return self.reply(204)

        def do_HEAD(self):
            return self.reply(200 if self.key() in objects else 404)

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    monkeypatch.setenv("AWS_ENDPOINT_URL", f"http://127.0.0.1:{server.server_port}")
    monkeypatch.setenv("AWS_REGION", "eu-north-1")
    monkeypatch.setenv("AWS_ACCESS_KEY_ID", "KEY-OF-TEST")
    monkeypatch.setenv("AWS_SECRET_ACCESS_KEY", "SECRET-OF-TEST")
    yield objects
    server.shutdown()
    server.server_close()


def test_a_volume_in_object_storage_is_one_for_every_reader_of_zarr(project, storage, tmp_path):
    xarray = pytest.importorskip("xarray")
    project.attribute("envelope", "strength")
    done = petroglyph.program.export(project.path, "s3://surveys/north/strength.zarr", volume="strength")
    assert done["url"] == "s3://surveys/north/strength.zarr"
    assert done["bytes"] == sum(map(len, storage.values()))
    for key, content in storage.items():
        assert b"SECRET-OF-TEST" not in content
        path = tmp_path / "found" / key
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    found = xarray.open_zarr(tmp_path / "found/surveys/north/strength.zarr", consolidated=False)
    assert found["0"].values.tobytes() == project.volume("strength").numpy().tobytes()
    assert found["inline"].values[0] == project.geometry.inlines[0]


def test_a_bucket_that_is_not_there_is_a_sentence_and_nothing_is_written(project, storage):
    with pytest.raises(petroglyph.PetroglyphError, match="no such bucket"):
        petroglyph.program.export(project.path, "s3://others/north.zarr", volume="seismic")
    assert storage == {}
