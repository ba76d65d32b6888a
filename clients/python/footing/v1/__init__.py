"""The messages of the protocol, as protoc makes them: `ninja python_messages` renews them."""
