#!/usr/bin/env python3
"""Reads a recording of an arena that was cut, and prints the last tick that can be read.

pip install mcap mcap-protobuf-support
cut.py FILE.mcap
"""

import sys

from mcap.exceptions import McapError
from mcap.stream_reader import StreamReader
from mcap.records import Channel, Message, Schema
from mcap_protobuf.decoder import DecoderFactory


def main(path):
    schemas, channels, decoders, last = {}, {}, {}, None
    factory = DecoderFactory()
    with open(path, "rb") as file:
        records = StreamReader(file).records
        while True:
            try:
                record = next(records)
            except (StopIteration, McapError):
                break
            if isinstance(record, Schema):
                schemas[record.id] = record
            elif isinstance(record, Channel):
                channels[record.id] = record
            elif isinstance(record, Message):
                channel = channels[record.channel_id]
                if channel.topic != "/arena":
                    continue
                if channel.id not in decoders:
                    schema = schemas[channel.schema_id]
                    decoders[channel.id] = factory.decoder_for(channel.message_encoding, schema)
                last = decoders[channel.id](record.data).tick
    print(last)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
