"""What the OpenAPI document says beyond what routes and schemas say themselves."""
